"""Do the two roads to the undisclosed load agree?"""

import pandas as pd


def roads_table(sets: pd.DataFrame, load_for_mean: float) -> pd.DataFrame:
    """One row a set: load on a mesh from the mean stiffness and from the fitted torque, and their ratio.

    The first road needs no dynamics: it is the torque on the pinion of one mesh at which contact analysis of
    the config's gear data has the paper's mean stiffness. The second is an equal share of the fitted torque
    of an input pinion over its two meshes.
    """
    fitted = sets["per_input_n_m"] / 2.0
    return pd.DataFrame(
        {
            "set": sets["set"],
            "load_from_mean_stiffness_n_m": load_for_mean,
            "load_from_fit_n_m": fitted,
            "ratio": fitted / load_for_mean,
        }
    )
