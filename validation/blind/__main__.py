"""`python -m validation.blind predict FOLDER` and `python -m validation.blind compare FOLDER`."""

import sys
from pathlib import Path

from facegear.errors import FacegearError
from validation.blind import MEASUREMENT, PREDICTION, SEAL, VERDICT, compare, predict, seal_of

USAGE = "usage: python -m validation.blind predict|compare FOLDER"


def main(arguments: list[str]) -> int:
    """Run one of the two commands.

    Parameters
    ----------
    arguments : list of str
        Command and folder.

    Returns
    -------
    int
        0, or 1 with a line on standard error.
    """
    if len(arguments) != 2 or arguments[0] not in ("predict", "compare"):
        print(USAGE, file=sys.stderr)
        return 1
    folder = Path(arguments[1])
    try:
        if arguments[0] == "predict":
            if (folder / MEASUREMENT).exists():
                raise FacegearError(f"{folder / MEASUREMENT}: a prediction comes before its measurement")
            predict(folder).to_csv(folder / PREDICTION, index=False, float_format="%.6g", lineterminator="\n")
            (folder / SEAL).write_text(f"{seal_of(folder)}  SHA-256\n", encoding="utf-8")
            print(f"{folder}: publish {PREDICTION} and {SEAL} before the measurement is opened")
        else:
            table = compare(folder)
            table.to_csv(folder / VERDICT, index=False, lineterminator="\n")
            print(table.to_string(index=False))
    except FacegearError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
