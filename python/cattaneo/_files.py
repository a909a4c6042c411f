"""Reads files by Python's libraries, and passes them to the core as arrays."""

import os
import tempfile
import zipfile
from typing import Any

import numpy as np

from ._core import InputError


def _matlab(matrix: str) -> dict[str, Any]:
    """The arrays of a .mat file, with K dense or sparse."""
    try:
        from scipy.io import loadmat
    except ImportError:
        raise InputError(f"file '{matrix}': SciPy reads MATLAB's files, and must be installed") from None
    try:
        found: dict[str, Any] = loadmat(matrix)
    except FileNotFoundError:
        raise InputError(f"file '{matrix}' cannot be read, must be there") from None
    except Exception as error:
        raise InputError(f"file '{matrix}' is not a .mat file of version 4 to 7.2 (save -v7): {error}") from None
    if "K" not in found:
        names = ", ".join(name for name in found if not name.startswith("__")) or "nothing"
        raise InputError(f"file '{matrix}' has no matrix K, there is {names}")
    arrays = {name: value for name, value in found.items() if not name.startswith("__")}
    if not isinstance(arrays["K"], np.ndarray):
        rows = arrays.pop("K").tocsr()
        arrays.update(data=rows.data, indices=rows.indices, indptr=rows.indptr, shape=np.array(rows.shape))
    return arrays


def plain(matrix: str) -> tuple[Any, str, bool] | None:
    """A folder to be kept until the file in it has been read, that file, and whether it has the places
    of rows. None if the core reads the original file."""
    if matrix.endswith(".mat"):
        arrays = _matlab(matrix)
    elif matrix.endswith(".npz") and zipfile.is_zipfile(matrix):
        with zipfile.ZipFile(matrix) as archive:
            if all(file.compress_type == zipfile.ZIP_STORED for file in archive.infolist()):
                return None
        try:
            with np.load(matrix) as stored:
                arrays = dict(stored)
        except Exception as error:
            raise InputError(f"file '{matrix}' is damaged: {error}") from None
    else:
        return None
    folder = tempfile.TemporaryDirectory()
    file = os.path.join(folder.name, "plain.npz")
    numbers = {name: np.asarray(value) for name, value in arrays.items()}
    np.savez(file, **{name: value for name, value in numbers.items() if value.dtype.kind in "fiu"})  # type: ignore[arg-type]
    return folder, file, "dofs" in arrays
