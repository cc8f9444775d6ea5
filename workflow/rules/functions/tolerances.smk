from facegear.config.tolerances import Tolerances as TolerancesSection
from facegear.config.tolerances import chunks


def tolerance_chunks(design):
    """Function of the wildcards giving the chunk files of a design, named by the samples they hold."""

    def files(wildcards):
        values = asked_values("tolerances", wildcards)
        section = parse_section(TolerancesSection, values["tolerances"])
        return [
            rules.tolerances_chunk.output.chunk.format(
                case=wildcards.case, design=design, first=first, last=last
            )
            for first, last in chunks(section, design)
        ]

    return files
