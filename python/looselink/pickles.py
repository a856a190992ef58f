"""What a pickle of a scene or a run needs to know."""

from __future__ import annotations

import pickle
import sys
import threading
from types import FrameType
from typing import Any

# Picklers that take functions by value, lambdas too.
BY_VALUE = {"cloudpickle", "dill"}

_tried = threading.local()


def check(callables: tuple[tuple[str, Any, Any] | None, ...]) -> None:
    """See that all callables of a scene, each as (path, function, tangent), can be pickled.

    A pickler says what it cannot pickle, not which part of the scene it is.

    Raises PicklingError for the first one that cannot.
    """
    # a callable that holds scenes is tried as a whole
    if getattr(_tried, "now", False) or _by_value():
        return
    _tried.now = True
    try:
        for path, *functions in filter(None, callables):
            try:
                pickle.dumps(functions)
            except Exception as error:
                raise pickle.PicklingError(
                    f"the callable of `{path}` cannot be pickled: {error}; functions and instances of classes of a module can"
                ) from error
    finally:
        _tried.now = False


def _by_value() -> bool:
    """Whether such a pickler is at work."""
    frame: FrameType | None = sys._getframe()
    while frame is not None:
        if BY_VALUE & set(frame.f_globals.get("__name__", "").split(".")):
            return True
        frame = frame.f_back
    return False
