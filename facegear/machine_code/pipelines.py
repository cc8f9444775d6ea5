"""How functions are compiled: which are made machine code, and what is linked into what.

Made of numba's private parts, as `stored.py` is.
"""

import gc
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from llvmlite import binding
from numba import config, jit
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering
from numba.core.typing.templates import _OverloadFunctionTemplate

from facegear.machine_code.passes import Passes
from facegear.machine_code.remembered import remembered

_LITTLE = 1
"""A level of optimisation that simplifies what is written."""


def _loops_as_written(level: int) -> Any:
    """Options of LLVM's passes at a level of optimisation, with loops neither unrolled nor made vectors."""
    options = binding.create_pipeline_tuning_options(speed_level=level)
    options.loop_unrolling = options.loop_vectorization = False
    options.slp_vectorization = config.SLP_VECTORIZE
    return options


class _CodeForCallers(JITCodeLibrary):
    """LLVM code that waits, as it was written, to be linked into what calls it.

    Where sums may be added in any `order`, which one it is follows from the passes over each function. Where
    products and sums may be fused, which are follows from them, too: passes that do little are enough for it
    and leave less to link and optimise.
    """

    order = fused = False
    _shared_module: Any
    _linking_libraries: list[JITCodeLibrary]

    def finalize(self) -> None:
        """Let it be linked into several others; what it calls itself is linked into these, too."""
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == binding.Linkage.external:
                function.linkage = "linkonce_odr"
        self._finalized = True

    def alone(self) -> Any:
        """Its functions without those that they call."""
        self._ensure_finalized()
        return self._final_module

    def called(self) -> list[JITCodeLibrary]:
        """All libraries that it needs, each behind all that call it: the linker leaves out what nothing that
        is linked already asks for.
        """
        callees_first: dict[JITCodeLibrary, None] = {}

        def visit(library: JITCodeLibrary) -> None:
            if library in callees_first:
                return
            for own in library._linking_libraries if isinstance(library, _CodeForCallers) else ():
                visit(own)
            callees_first[library] = None

        for library in self._linking_libraries:
            visit(library)
        return list(reversed(callees_first))

    def _get_module_for_linking(self) -> Any:
        """Its functions with those that they call, for a library of numba's own."""
        if self._shared_module is None:
            self._shared_module = self.alone().clone()
            _link(self._shared_module, self.called())
        return self._shared_module

    def _optimize_functions(self, module: Any) -> None:
        if self.order:
            super()._optimize_functions(module)
        elif self.fused:
            module.data_layout = self._codegen._data_layout
            builder = binding.create_pass_builder(self._codegen._tm, _loops_as_written(_LITTLE))
            passes = builder.getFunctionPassManager()
            for function in module.functions:
                if not function.is_declaration:
                    passes.run(function, builder)


def _link(module: Any, libraries: Iterable[JITCodeLibrary]) -> None:
    """Link libraries into a module, each alone: numba would link what they call with each of them again."""
    for library in libraries:
        own = library.alone() if isinstance(library, _CodeForCallers) else library._get_module_for_linking()
        module.link_in(own, preserve=True)


class _CodeOfAll(_CodeForCallers):
    """LLVM code of a function that Python calls, with all that it calls, made machine code."""

    def finalize(self) -> None:
        """Link it together, optimise it and compile it."""
        libraries = self.called()
        for library in libraries:
            self._reload_init.update(library._reload_init)
        _link(self._final_module, libraries)
        self._linking_libraries = []
        JITCodeLibrary.finalize(self)

    def _get_module_for_linking(self) -> Any:
        return JITCodeLibrary._get_module_for_linking(self)


class _CodeAsWritten(_CodeOfAll):
    """LLVM code whose loops are neither unrolled nor made vectors.

    Those of the time integration are short, or vectors already: LLVM would make twice the code of them, which
    takes three times as long to compile and runs no faster.
    """

    def _optimize_final_module(self) -> None:
        builder = binding.create_pass_builder(self._codegen._tm, _loops_as_written(config.OPT))
        builder.getModulePassManager().run(self._final_module, builder)


@register_pass(mutates_CFG=True, analysis_only=False)
class _Lower(NativeLowering):
    """Numba's lowering, to LLVM code of a `kind`."""

    _name = "lower_whole"
    kind: type[_CodeForCallers] = _CodeOfAll

    def run_pass(self, state: Any) -> bool:
        """Make the code of a function, which only Python and compiled callers call."""
        state.flags.no_cfunc_wrapper = True
        state.library = self.kind(state.targetctx.codegen(), state.func_id.func_qualname)
        allowed = state.flags.fastmath.flags if state.flags.fastmath else set()
        state.library.order, state.library.fused = not allowed <= {"contract"}, "contract" in allowed
        state.library.enable_object_caching()
        return bool(super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
class _LowerAsWritten(_Lower):
    _name, kind = "lower_as_written", _CodeAsWritten


@register_pass(mutates_CFG=True, analysis_only=False)
class _LowerForCallers(_Lower):
    _name, kind = "lower_for_callers", _CodeForCallers

    def run_pass(self, state: Any) -> bool:
        state.flags.no_compile = state.flags.no_cpython_wrapper = True
        super().run_pass(state)
        lowered = state["cr"]

        def entry(*arguments: Any) -> None:
            raise TypeError(f"{lowered.fndesc.qualname} is only for compiled callers")

        state.targetctx.insert_user_function(entry, lowered.fndesc, [state.library])
        state["cr"] = lowered._replace(cfunc=entry)
        return True


def _with(lowering: type[NativeLowering]) -> type[Compiler]:
    """Numba's compiler with another way to make LLVM code, and without the collection of garbage: nearly all
    that it makes is used to the end.
    """

    class Lowering(Compiler):
        def define_pipelines(self) -> list[Any]:
            made = []
            for pipeline in super().define_pipelines():
                passes = [
                    (lowering, name) if step is NativeLowering else (step, name)
                    for step, name in pipeline.passes
                ]
                made.append(Passes(pipeline.pipeline_name, passes))
                made[-1].finalize()
            return made

        def _compile_core(self) -> Any:
            collects = gc.isenabled()
            gc.disable()
            try:
                with remembered(), _numbas_own_as_parts():
                    return super()._compile_core()
            finally:
                if collects:
                    gc.enable()

    return Lowering


Whole, AsWritten, ForCallers = _with(_Lower), _with(_LowerAsWritten), _with(_LowerForCallers)
"""For functions that Python calls, for those whose loops stay as they are, and for parts of others."""


def _part(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator for functions of numba's own, which are written for the literal values of arguments, too."""

    def decorated(function: Callable[..., Any]) -> Any:
        dispatcher = jit(pipeline_class=ForCallers, **options)(function)

        def add_overload(overload: Any) -> None:
            dispatcher.overloads[tuple(overload.signature.args)] = overload

        dispatcher.add_overload = add_overload
        return dispatcher

    return decorated


@contextmanager
def _numbas_own_as_parts() -> Iterator[None]:
    """Have functions of numba's own, such as those behind max(), be parts of their callers: it makes machine
    code of each of them, which nothing calls.
    """
    own = _OverloadFunctionTemplate._get_jit_decorator
    _OverloadFunctionTemplate._get_jit_decorator = lambda template: _part
    try:
        yield
    finally:
        _OverloadFunctionTemplate._get_jit_decorator = own
