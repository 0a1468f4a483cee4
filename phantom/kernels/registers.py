"""Which registers the compiler may fill: the widest that the processor has.

LLVM keeps to half of a 512-bit register by default, since early processors slowed down when they
used all of it. The loops over lanes are long chains of sums and products that wait for each other:
twice the lanes in the same number of instructions is worth more than the clock.
"""

from __future__ import annotations

from typing import Any, Final

from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.lowering import Lower
from numba.core.typed_passes import BaseNativeLowering, NativeLowering

WIDEST: Final = '"prefer-vector-width"="512"'
"""An attribute of LLVM's functions; processors without such registers take their own width."""


class WideLower(Lower):
    """Lowers a function as numba does, and asks for the widest registers in it."""

    def setup_function(self, fndesc: Any) -> None:
        """Begin the function, and mark it."""
        super().setup_function(fndesc)  # type: ignore[no-untyped-call]
        # llvmlite knows only attributes without a value, but writes down any.
        set.add(self.function.attributes, WIDEST)


@register_pass(mutates_CFG=True, analysis_only=False)  # type: ignore[no-untyped-call]
class WideLowering(BaseNativeLowering):
    """The last pass, with our lowering."""

    _name = "wide_lowering"  # type: ignore[assignment]

    @property
    def lowering_class(self) -> type[Lower]:
        """Return what lowers a function."""
        return WideLower


class WideCompiler(CompilerBase):
    """Numba's own pipeline, with our lowering in the place of its own."""

    def define_pipelines(self) -> list[Any]:
        """Return the passes."""
        passes: Any = DefaultPassBuilder.define_nopython_pipeline(  # type: ignore[no-untyped-call]
            self.state
        )
        passes.passes = [
            (WideLowering, told) if one is NativeLowering else (one, told)
            for one, told in passes.passes
        ]
        passes.finalize()
        return [passes]


class LoopCompiler(WideCompiler):
    """For loops over lanes: what they write is none of the other arrays that they read.

    Without that promise a loop that looks things up in a table is never packed.
    """

    def define_pipelines(self) -> list[Any]:
        """Return the passes."""
        self.state.flags.noalias = True
        return super().define_pipelines()
