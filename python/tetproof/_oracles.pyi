"""Without comfort; use tetproof."""
from typing import Any, Dict, Mapping, Optional

from numpy.typing import NDArray

Array = NDArray[Any]

least_envelope: float
def verify(points: Array, triangles: Array, labels: Optional[Array], names: Mapping[int, str], mesh: Mapping[str, Any], promised: str,
           envelope: float, declared_deviation: float, threads: int) -> Dict[str, Any]: ...
def measure(mesh: Mapping[str, Any]) -> str: ...
