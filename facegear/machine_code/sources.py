"""The text of the sources that machine code is stored for."""

import hashlib
from pathlib import Path


def text_of(*sources: Path) -> str:
    """Hash of the text of all Python files in some folders, or of files."""
    digest = hashlib.sha256()
    for source in sources:
        for path in sorted(source.glob("*.py")) if source.is_dir() else [source]:
            digest.update(path.read_bytes())
    return digest.hexdigest()
