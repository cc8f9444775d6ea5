from facegear.paper.config.reproduction import design_points
from facegear.paper.config.sections import branches

IDENTIFY = REPRODUCTION.identify if REPRODUCTION else None
IDENTIFY_VALUES = IDENTIFY.model_dump(mode="json") if IDENTIFY else None
DESIGNS = list(design_points(IDENTIFY))
BRANCHES = [branch.name for branch in branches(IDENTIFY)] if IDENTIFY else []
