"""Numba's passes over a function, without what nothing of this package needs.

Made of numba's private parts, as `stored.py` is.
"""

from collections.abc import Callable
from types import CodeType
from typing import Any

from numba import types
from numba.core.compiler_machinery import PassManager, _pass_registry
from numba.core.errors import new_error_context
from numba.core.transforms import canonicalize_cfg
from numba.core.typed_passes import (
    AnnotateTypes,
    DumpParforDiagnostics,
    InlineOverloads,
    NopythonRewrites,
    NoPythonSupportedFeatureValidation,
)
from numba.core.untyped_passes import (
    FindLiterallyCalls,
    InlineClosureLikes,
    InlineInlinables,
    LiteralPropagationSubPipelinePass,
    LiteralUnroll,
    MakeFunctionToJitFunction,
    WithLifting,
)

_LEFT_OUT = frozenset(
    {
        AnnotateTypes,
        DumpParforDiagnostics,
        FindLiterallyCalls,
        InlineInlinables,
        InlineOverloads,
        LiteralPropagationSubPipelinePass,
        LiteralUnroll,
        NoPythonSupportedFeatureValidation,
        WithLifting,
    }
)
"""For literal values, blocks of `with`, numba's own inlining and reports: no function here has any."""


class Passes(PassManager):
    """Passes one after the other, those left out that would change nothing.

    Numba tells listeners what each begins with, and finds out after each how long all variables live; the
    passes that ask for it find it out themselves.
    """

    def __init__(self, name: str, passes: list[Any]) -> None:
        super().__init__(name)
        self.passes = [(step, text) for step, text in passes if step not in _LEFT_OUT]

    def _runPass(self, index: int, pss: Any, state: Any) -> None:
        if not _NEEDED.get(type(pss), _always)(state):
            return
        pss.analysis = self._analysis
        with new_error_context("Pass {name}", name=pss.name()):
            pss.run_initialization(state)
            pss.run_pass(state)
            pss.run_finalizer(state)
        if _pass_registry.get(type(pss)).mutates_CFG:
            state.func_ir.blocks = canonicalize_cfg(state.func_ir.blocks)


def _always(state: Any) -> bool:
    return True


def _has_functions(state: Any) -> bool:
    """Whether other functions stand inside the function, those of list displays among them."""
    return any(isinstance(constant, CodeType) for constant in state.func_id.code.co_consts)


def _returns_arrays(state: Any) -> bool:
    """Whether any operation or call gives an array: those of array expressions are joined."""
    signatures = (signature for signature in state.calltypes.values() if signature is not None)
    return any(isinstance(signature.return_type, types.Array) for signature in signatures)


_NEEDED: dict[type, Callable[[Any], bool]] = {
    InlineClosureLikes: _has_functions,
    MakeFunctionToJitFunction: _has_functions,
    NopythonRewrites: _returns_arrays,
}
"""Whether a pass has anything to do."""
