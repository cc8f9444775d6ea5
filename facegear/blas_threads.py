"""One thread of BLAS while something is computed."""

from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Limit the libraries of linear algebra to one thread; afterwards they have as many as before.

    Fronts of an elimination and matrices of a contact or of a machine are small. Threads that wait for one
    another at full speed take several times the processor time there, and on a busy machine longer as well.

    Returns
    -------
    Iterator[None]
        A context, with nothing to be used inside.
    """
    with threadpool_limits(limits=1):
        yield
