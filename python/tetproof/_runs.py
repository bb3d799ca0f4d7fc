"""What all jobs share: options, progress, messages in the words of Python, and how runs end."""
import contextlib
import dataclasses
import difflib
import inspect
import re
import sys
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Tuple, TypeVar, Union

import numpy as np

from . import _core
from ._surfaces import Array, Defect

#: Called several times a second with the phase, the fraction done (negative: unknown) and the vertices so far; False ends the run.
Progress = Callable[[str, float, int], Optional[bool]]


class Error(Exception):
    """A run ended without a result; the message says why."""


class LimitReached(Error):
    """Vertices, tetrahedra, time, memory or the precision of doubles.

    Attributes
    ----------
    limit : str
        "size", "budget", "time", "memory" or "precision".
    """

    def __init__(self, message: str, limit: str = ""):  # with a default, or it could not leave another process
        super().__init__(message)
        self.limit = limit


class Interrupted(Error):
    """The progress callable returned False."""


class InvalidMesh(Error, ValueError):
    """The mesh given to `improve` is not conforming."""


@dataclasses.dataclass(eq=False)
class _Found:
    valid: bool
    message: str
    counts: Dict[str, int]
    places: Dict[str, Array]
    hints: List[str]
    warnings: List[str]


@dataclasses.dataclass(eq=False)
class Report(_Found):
    """What `check` found.

    Attributes
    ----------
    valid : bool
    message : str
        The first defect; empty if there is none.
    counts : dict of str to int
        Defects by kind: "open edge", "self-intersection", ...
    defects : list of Defect
        Described: at most ten of each kind.
    hints : list of str
        What to do about the defects, as far as that is known.
    places : dict of str to (n, 2) int32
        All of each kind, up to a million: the two ends of an edge ("open edge", "non-manifold edge", "inconsistent orientation"), two
        triangles ("self-intersection", "duplicate triangle"), a vertex twice ("non-manifold vertex", "non-finite coordinate") or a
        triangle twice ("degenerate triangle", "vertex index out of range").
    components, facets, acute_vertices, acute_edges : int
    volume, bbox_diagonal, smallest_local_feature_size : float
        Only of a valid surface, but for the diagonal.
    flipped : bool
        The surface was inside out, which is not a defect.
    """
    defects: List[Defect]
    flipped: bool
    components: int
    facets: int
    acute_vertices: int
    acute_edges: int
    volume: float
    bbox_diagonal: float
    smallest_local_feature_size: float


@dataclasses.dataclass(eq=False)
class PlaneReport(_Found):
    """What `check_plane` found.

    Attributes
    ----------
    valid, message, hints, warnings
        As of `Report`.
    counts : dict of str to int
        By kind: "equal vertices", "segment without length", "overlap", "crossing".
    places : dict of str to (n, 2) int32
        All of each kind, up to a million: two points ("equal vertices"), or two segments, or one twice.
    area : float
        Of the inside; 0 if it is not valid.
    """
    area: float


class InvalidSurface(Error, ValueError):
    """The surface is not closed, manifold, oriented and free of self-intersections.

    Attributes
    ----------
    report : Report
        What `check` says of it.
    defects : list of Defect
        Described: at most ten of each kind.
    counts : dict of str to int
        How many defects there are of each kind.
    places : dict of str to (n, 2) int32
        All of them, as in `Report`.
    """

    def __init__(self, message: str, report: "Optional[Report]" = None):
        if report and len(report.defects) > 1:
            message += "; in all " + ", ".join("%s: %d" % count for count in report.counts.items())
        if report and report.hints:
            message += "; " + report.hints[0]
        super().__init__(message)
        self.report = report
        self.defects = report.defects if report else []
        self.counts = report.counts if report else {}
        self.places = report.places if report else {}

#: Values of options that are words.
_WORDS = sorted({word for options in _core.options.values() for _, kind, *_ in options for word in re.findall(r"'(\w+)'", kind)})


def _in_python(text: str) -> str:
    """What messages say of the command line, as it is called here."""
    def argument(match: "re.Match[str]") -> str:
        name, value = match[1].replace("-", "_"), match[2]
        return name if value is None else "%s=%s" % (name, repr(value) if value in _WORDS else value)

    def call(match: "re.Match[str]") -> str:
        arguments = [argument(found) for found in re.finditer(r"--([a-z-]+)(?: ([^ -][^ ]*))?", match[2])]
        return "`tetproof.%s(%s)`" % (match[1], ", ".join(a if "=" in a else a + "=True" for a in arguments))

    text = re.sub(r"`delmesher ([a-z]+)([^`]*)`", call, text)
    outside = re.split(r"(`[^`]*`)", text)  # commands of the harness stay
    given = r"--([a-z][a-z-]*)(?: (%s|[0-9](?:[0-9.e+-]*[0-9])?)\b)?" % "|".join(_WORDS)
    return "".join(part if part.startswith("`") else re.sub(given, argument, part) for part in outside)


def _of_planes(text: str) -> str:
    return _in_python(text).replace("tetproof.repair(", "tetproof.repair_plane(")

_Function = TypeVar("_Function", bound=Callable[..., Any])


def _with_options(function: _Function) -> _Function:
    """Puts the options of a job, of the function's name, into its signature and docstring."""
    signature, lines = inspect.signature(function), []
    parameters = [p for p in signature.parameters.values() if p.kind != p.VAR_KEYWORD]
    for name, kind, default, unit, text in _core.options[function.__name__]:
        parameters.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default))
        lines.append("%s : %s, %s" % (name, kind, "optional" if default is None else "default %r" % default))
        text = _in_python(text)
        lines.append("    %s%s." % (text[0].upper() + text[1:], unit and ", " + unit))
    function.__signature__ = signature.replace(parameters=parameters)  # type: ignore
    if function.__doc__:  # not there with -OO
        # From Python 3.13 on it is not indented.
        function.__doc__ = re.sub(r"^( *)\*\*options\n", lambda found: "".join(found[1] + line + "\n" for line in lines), function.__doc__, flags=re.M)
    return function


def _value(value: Any) -> Union[str, float]:
    """Names of regions, and lengths in some, as one text."""
    if isinstance(value, Mapping):
        return ",".join(str(x) if name is None else "%s=%r" % (name, float(x)) for name, x in value.items())
    if isinstance(value, (list, tuple)):
        return ",".join(value)
    return value if isinstance(value, str) else float(value)


def _options(job: str, given: Mapping[str, Any]) -> Dict[str, Any]:
    options = {name: value for name, value in given.items() if value is not None}
    names = [name for name, *_ in _core.options[job]]
    unknown = sorted(set(options) - set(names))
    if unknown:
        near = difflib.get_close_matches(unknown[0], names, 1)
        hint = ": did you mean %s?" % near[0] if near else " (there are %s)" % ", ".join(names)
        raise TypeError("no such option: %s%s" % (", ".join(unknown), hint))
    if "size_growth" in options and "size_field" not in options:
        raise ValueError("size_growth: of no effect without size_field")
    named: Dict[str, Any] = {name: _value(value) for name, value in options.items() if name != "size_field"}
    if "size_field" in options:
        named["size_field"] = np.ascontiguousarray(options["size_field"], dtype=np.float64)
    return named


def _raise(result: Dict[str, Any], report: Callable[[], Optional[Report]] = lambda: None) -> None:
    status, message = result["status"], _in_python(result["message"])
    if status == "ok":
        return
    if status == "invalid_options":
        raise ValueError(message)
    if status == "invalid_surface":
        raise InvalidSurface(message, report())
    if status == "invalid_mesh":
        raise InvalidMesh(message)
    if status == "limit_reached":
        raise LimitReached(message, result["limit"])
    if status == "interrupted":
        raise Interrupted(message)
    raise Error(message)


def _raise_plane(result: Dict[str, Any]) -> None:
    _raise({**result, "message": _of_planes(result["message"])})


class _Bar:
    """A progress bar, of tqdm if it is there, else a line; anew for every phase, so that the time left is that of the phase."""

    def __init__(self) -> None:
        self.phase, self.width = "", 0
        self.bar: Any = None
        self.stream = sys.stdout if "ipykernel" in sys.modules else sys.stderr  # notebooks show stderr in red
        try:
            from tqdm.auto import tqdm

            # In a notebook without widgets this is what fails.
            self.bar = tqdm(total=1, bar_format="{desc:<10}{percentage:3.0f}%|{bar}| [{elapsed}<{remaining}{postfix}]")
        except ImportError:
            pass

    def show(self, phase: str, done: float, vertices: int) -> None:
        if self.bar is None:
            text = phase if done < 0 else "%-9s %3d %%" % (phase, 100 * done)
            text += ", %d points" % vertices if vertices else ""
            print("\r" + text.ljust(self.width), end="", file=self.stream, flush=True)
            self.width = len(text)
            return
        if phase != self.phase:
            self.phase = phase
            self.bar.reset(total=1)
            self.bar.set_description_str(phase, refresh=False)
        self.bar.n = min(max(done, 0), 1)
        self.bar.set_postfix_str("%d points" % vertices if vertices else "", refresh=False)
        self.bar.refresh()

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()
        elif self.width:
            print(file=self.stream)


@contextlib.contextmanager
def _shown(progress: Any) -> Iterator[Any]:
    """What is to be called: the user's callable, or for True that of a bar."""
    if progress is not True:
        yield progress or None
        return
    bar = _Bar()
    try:
        yield bar.show
    finally:
        bar.close()


def _run(job: str, given: Tuple[Any, ...], progress: Any, options: Mapping[str, Any], **more: Any) -> Dict[str, Any]:
    named = {**_options(job, options), **more}
    with _shown(progress) as shown:
        result: Dict[str, Any] = getattr(_core, job)(*given, named, shown)
    return result
