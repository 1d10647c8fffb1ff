"""Numba compiles kernels, and keeps them, in less time than it takes for functions in general.

Numba optimises a function by itself and once more in each function that calls it, makes machine
code of both, and keeps what later callers would need. Here only kernels are called from Python and
only parts from kernels, so that parts are left to the kernels, and of kernels the machine code is
all that is needed. Both are said by a class of numba's libraries, as it calls the code of one
function with all that it calls. Steps of its compiler that look for what no kernel has are left
out.
"""

from __future__ import annotations

import gc
from typing import Any

from llvmlite.binding import Linkage, parse_assembly
from numba import _dynfunc
from numba.core.caching import FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.runtime import rtsys

for _name in (
    "_finalize_final_module",
    "_get_compiled_object",
    "_optimize_final_module",
    "serialize_using_object_code",
):
    # Numba promises none of these: one that lacks any is not used at all (`can_compile`).
    getattr(JITCodeLibrary, _name)

_NEEDLESS_STEPS = {
    "WithLifting",  # "with" statements
    "InlineClosureLikes",  # functions in functions, comprehensions
    "RewriteDynamicRaises",  # exceptions with values
    "MakeFunctionToJitFunction",  # functions as values
    "InlineInlinables",  # what asks to be made part of its callers' source
    "InlineOverloads",
    "LiteralUnroll",  # loops over unlike items
    "LiteralPropagationSubPipelinePass",
    "NopythonRewrites",  # arithmetic with whole arrays
}
"""Steps of numba's compiler, with what they look for; each has all variables analysed anew."""


class _KernelLibrary(JITCodeLibrary):  # type: ignore[misc]  # numba is not typed
    """The code of a kernel, of which the machine code alone is kept on disk."""

    def serialize_using_object_code(self) -> tuple[str, str, tuple[bytes, bytes]]:
        """Return what is kept: the machine code, and in place of LLVM's code the names in it.

        Numba looks up the function that Python calls among these names. To read all of LLVM's code
        takes longer than to read the machine code.
        """
        functions = (each for each in self._final_module.functions if not each.is_declaration)
        own = (each.name for each in functions if each.linkage == Linkage.external)
        names = "\n".join(f'@"{name}" = global i8 0' for name in own)
        bitcode = parse_assembly(names).as_bitcode()
        return self.name, "object", (self._get_compiled_object(), bitcode)


class _PartLibrary(JITCodeLibrary):  # type: ignore[misc]  # numba is not typed
    """The code of a part, which is optimised and made machine code where it is linked to."""

    def _optimize_final_module(self) -> None:
        """Leave the code of a part that calls others as it is.

        Small functions are optimised before they become part of larger ones: kernels that sample
        images would take 1.1 to 1.6 times as long with a `bilinear` that is not.
        """
        if not any(isinstance(each, _PartLibrary) for each in self._linking_libraries):
            super()._optimize_final_module()

    def _finalize_final_module(self) -> None:
        """Make no machine code."""
        self._finalized = True


def _make_uncallable(library: _PartLibrary, function: Any, environment: Any) -> Any:
    """Return what numba takes for the compiled function of a part; nothing can call it."""
    name = function.qualname.rpartition(".")[-1]
    module = function.lookup_module()
    return _dynfunc.make_function(module, name, "", 0, environment, (library,))


class KernelCompiler(Compiler):  # type: ignore[misc]  # numba is not typed
    """Numba's compiler, of kernels and their parts."""

    def define_pipelines(self) -> Any:
        """Return numba's lists of steps without those that kernels do not need."""
        pipelines = super().define_pipelines()
        for each in pipelines:
            each.passes = [step for step in each.passes if step[0].__name__ not in _NEEDLESS_STEPS]
            each.finalize()
        return pipelines

    def compile_extra(self, function: Any) -> Any:
        """Compile a function: a part if it is without what Python calls it by, else a kernel.

        No garbage is looked for meanwhile. What a compiler builds is alive until it is done; to
        look through it again and again takes a sixth of the time.
        """
        state = self.state
        is_part = state.flags.no_cpython_wrapper
        library = _PartLibrary if is_part else _KernelLibrary
        state.library = library(state.targetctx.codegen(), function.__qualname__)
        state.library.enable_object_caching()
        if is_part:
            state.targetctx = state.targetctx.subtarget(get_executable=_make_uncallable)
        was_enabled = gc.isenabled()
        gc.disable()
        try:
            return super().compile_extra(function)
        finally:
            if was_enabled:
                gc.enable()


class KernelCache(FunctionCache):  # type: ignore[misc]  # numba is not typed
    """Numba's place of compiled functions on disk, read without all that compiling takes.

    Numba's own declares to its compiler everything that compiled functions may call before it reads
    one, which takes longer than to read all kernels of a calibration. Its compiler declares the
    same again when it is needed; what is read needs the runtime, by which memory is allocated.
    """

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load a kernel for a signature; return None if there is none."""
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)

    def is_filled(self) -> bool:
        """Return whether the kernel is kept for some kind of arguments."""
        return bool(self._cache_file._load_index())
