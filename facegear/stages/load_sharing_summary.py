"""Load sharing of the machine itself and of all points of its studies, study by study."""

from collections.abc import Sequence

import pandas as pd

from facegear.load_sharing.collect import NOMINAL, collect_tables
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome


def load_sharing_summary(
    points: Sequence[Sequence[str]], summaries: Sequence[pd.DataFrame], curves: Sequence[pd.DataFrame]
) -> Outcome:
    """Collect the load sharing of the machine and of all points of its studies.

    Parameters
    ----------
    points : Sequence[Sequence[str]]
        Study, point and label of every point.
    summaries : Sequence[pd.DataFrame]
        Tables `summary` of stage load_sharing, that of the machine itself first.
    curves : Sequence[pd.DataFrame]
        Tables `curve` of the points alone.

    Returns
    -------
    Outcome
        `summary` (table) of all, and `studies` (a table of curves for each study).
    """
    keys = [(study, point) for study, point, _ in points]
    labels = {(study, point): label for study, point, label in points}
    frames = dict(zip([(NOMINAL, NOMINAL), *keys], summaries, strict=True))
    summary, every = collect_tables(frames, labels), dict(zip(keys, curves, strict=True))
    studies = [
        collect_tables({key: frame for key, frame in every.items() if key[0] == name}, labels)
        for name in dict.fromkeys(study for study, _ in keys)
    ]
    irregular = summary.loc[~summary["periodic"].astype(bool), ["study", "point"]].drop_duplicates()
    text = f"{count_noun(len(frames), 'case')}, "
    text += f"{len(irregular)} of them not periodic" if len(irregular) else "all periodic"
    return Outcome({"summary": summary, "studies": studies}, text)
