"""The summary of all studies holds the rows of each case, and says of how many the motion does not repeat."""

import pandas as pd
from references import against, agrees

from facegear.stages.load_sharing_summary import load_sharing_summary

POINTS = [("backlash", "0", "80 um"), ("backlash", "1", "120 um"), ("bearing", "0", "soft")]


@against(
    "manufactured",
    "tables of four cases",
    capability="load_sharing_summary",
    module="facegear.load_sharing.collect",
)
def test_each_case_stands_in_the_summary_with_its_own_numbers_and_in_its_own_study():
    means = [1.1, 1.2, 1.3, 1.4]
    summaries = [
        pd.DataFrame({"group": ["inputs", "idlers"], "mean": [mean, 1.0], "periodic": mean != 1.3})
        for mean in means
    ]
    curves = [pd.DataFrame({"cycle": [0.0, 0.5], "coefficient": 2 * [mean]}) for mean in means[1:]]
    outcome = load_sharing_summary(POINTS, summaries, curves)
    summary = outcome.content["summary"].set_index(["study", "label", "group"])["mean"]
    cases = [("nominal", "nominal"), *((study, label) for study, _, label in POINTS)]
    agrees("mean coefficient", [summary[(*case, "inputs")] for case in cases], means)
    backlash, bearing = outcome.content["studies"]
    agrees("coefficient over a cycle, first study", backlash["coefficient"], [1.2, 1.2, 1.3, 1.3])
    agrees("coefficient over a cycle, second study", bearing["coefficient"], [1.4, 1.4])
    assert outcome.summary == "4 cases, 1 of them not periodic"
