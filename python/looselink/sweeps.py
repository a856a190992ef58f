"""Sweeps: a scene at many values of its fields, on the cores of this machine or on the workers of a Dask cluster."""

from __future__ import annotations

import contextlib
import json
import math
import os
import pickle
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from copy import deepcopy
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._looselink import RunWarning, Scene, __version__, _expect_version, _make_tasks, _Sweep, _text_of, load

if TYPE_CHECKING:
    import pandas
    import polars

# Batches that wait at the workers: enough to keep them busy, few enough that a million runs do not burden the scheduler.
AHEAD = 3
# Time between two counts of the workers [s].
LOOK = 1.0
# Time between two looks at tasks while none has ended [s].
POLL = 0.005


class SweepResult:
    """Tables and pictures of a sweep.

    `folder` holds the files that docs/sweep.md lists; `summary` is what `sweep.json` says. In a notebook the pictures are shown.
    """

    def __init__(self, folder: Path, kept: Any = None) -> None:
        self.folder = folder
        # a temporary folder lives as long as the result
        self._kept = kept
        self.summary: dict[str, Any] = json.loads((folder / "sweep.json").read_text(encoding="utf-8"))

    def __repr__(self) -> str:
        return f"<looselink.SweepResult {self.summary['title']!r}, {', '.join(self._counts())} in {str(self.folder)!r}>"

    def _counts(self) -> list[str]:
        others = {"failed": self.summary["status"]["failed"], "refused": self.summary["status"]["refused"]}
        counts = [f"{self.summary['runs']} runs", *(f"{count} {name}" for name, count in others.items() if count)]
        return [*counts, f"{self.summary['warned']} with warnings"] if self.summary["warned"] else counts

    def __copy__(self) -> SweepResult:
        copy = object.__new__(SweepResult)
        copy.__dict__.update(self.__dict__)
        return copy

    def __deepcopy__(self, memo: dict[int, Any]) -> SweepResult:
        # the files are those of both
        copy = self.__copy__()
        copy.summary = deepcopy(self.summary, memo)
        return copy

    def __getstate__(self) -> dict[str, Any]:
        if self._kept is not None:
            raise pickle.PicklingError(
                f"the files of this sweep are in the temporary folder {str(self.folder)!r}, which is deleted with the result: "
                "a sweep with `out` can be pickled"
            )
        return {"version": __version__, "folder": self.folder.absolute(), "summary": self.summary}

    def __setstate__(self, state: dict[str, Any]) -> None:
        _expect_version(state["version"])
        self.folder, self.summary, self._kept = state["folder"], state["summary"], None

    @property
    def page(self) -> str:
        """Extremes, answers, runs without results and warnings, in Markdown."""
        return (self.folder / "sweep.md").read_text(encoding="utf-8")

    def to_pandas(self) -> pandas.DataFrame:
        """One row a run as a pandas.DataFrame; columns are called "name [unit]", `.attrs["units"]` has the units by name.

        Raises ImportError without pandas.
        """
        import pandas

        # pandas 2 reads numbers with an error of the last digit unless it is told not to; later ones do not know the option
        exact: dict[str, Any] = {} if int(pandas.__version__.split(".")[0]) > 2 else {"float_precision": "round_trip"}
        frame = pandas.read_csv(self.folder / "sweep.csv", keep_default_na=False, na_values=[""], **exact)
        frame = frame.rename(columns=_text_of)
        for name in frame.select_dtypes(exclude=["number", "bool"]):
            frame[name] = frame[name].map(_text_of, na_action="ignore")
        frame.attrs["title"] = self.summary["title"]
        frame.attrs["units"] = self.summary["units"]
        return frame

    def to_polars(self) -> polars.DataFrame:
        """One row a run as a polars.DataFrame; columns are called by their names alone, as in `sweep.parquet`.

        Raises ImportError without Polars.
        """
        import polars

        return polars.read_parquet(self.folder / "sweep.parquet")

    def _repr_svg_(self) -> str:
        return (self.folder / "sweep.svg").read_text(encoding="utf-8")


def sweep(
    study: str | os.PathLike[str] | dict[str, Any],
    client: Any = None,
    *,
    out: str | os.PathLike[str] | None = None,
    target: tuple[str, float] | None = None,
    threads: int | None = None,
    batch: int | None = None,
    progress: bool | Callable[[int, int], object] = False,
    force: bool = False,
    copy_to: str | None = None,
) -> SweepResult:
    """Make all runs of a study that are missing, then tables and pictures.

    `study` is a study file, or a dict with the tables of docs/sweep.md whose `scene` is a path or a `Scene`.
    `client` is a `distributed.Client`: the runs are made by its workers; without one by `threads` threads of this process.
    `out` is the folder that receives rows, tables and pictures; the same call goes on with rows that are there. Without it the
    files are in a temporary folder, which the result keeps.
    `target` is (measure, value): the study becomes a bisection for the value of its one parameter at which the measure has the value.
    `batch` is the number of runs of a task of Dask; by default tasks take about a second.
    `progress` is True, or a callable that receives the numbers of runs made and left.
    `force` begins anew; the rows and tables that are there are kept in `previous-result` until the new sweep is complete.
    `copy_to` is an address that pyarrow's file systems reach, such as "s3://bucket/folder": tables and pictures are copied there.

    The tables have the same bytes as those of `looselink sweep`, whatever the number of threads, workers and interruptions.

    Warns by the category RunWarning of runs without results and of runs with warnings.

    Raises StudyError for a fault of the study or of a value that it gives the scene, SceneError for other faults of the scene,
    OSError for files that cannot be written, RuntimeError for a bisection without an answer and for workers with another version
    of Looselink, KeyboardInterrupt after Ctrl-C; rows that are made stay in `out`.
    """
    if batch is not None and batch < 1:
        raise ValueError(f"batch must be 1 at least, not {batch}")
    if client is not None and not hasattr(client, "submit"):
        raise TypeError(f"client must be a distributed.Client, not {type(client).__name__}; tables of a study are keyword arguments")
    if copy_to is not None:
        _place(copy_to)
    prepared = _prepared(study, target)
    kept = None
    if out is None:
        kept = tempfile.TemporaryDirectory(prefix="looselink-sweep-")
        out = kept.name
    folder = Path(out)
    shown = _shown(progress)
    prepared.open(folder, force)
    try:
        if client is None:
            prepared.make(threads, shown)
        else:
            _distribute(prepared, client, batch, shown)
        prepared.merge()
    finally:
        # a traceback that is kept would keep the lock of the folder
        prepared.close()
    result = SweepResult(folder, kept)
    counts = result._counts()
    if len(counts) > 1:
        warnings.warn(f"{', '.join(counts)}: see `page` of the result", RunWarning, stacklevel=2)
    if copy_to is not None:
        _copy(folder, copy_to)
    return result


# Keyword arguments of `sweep`, which are not tables of a study.
OPTIONS = ("out", "threads", "batch", "progress", "force", "copy_to")


def of_scene(scene: Scene, client: Any, **keywords: Any) -> SweepResult:
    """`Scene.sweep`."""
    options = {name: keywords.pop(name) for name in OPTIONS if name in keywords}
    if not isinstance(keywords.get("target", {}), dict):
        # (measure, value); a dict is the table `[target]` of a study
        options["target"] = keywords.pop("target")
    return sweep({"title": scene.title, **keywords, "scene": scene}, client, **options)


def _prepared(study: str | os.PathLike[str] | dict[str, Any], target: tuple[str, float] | None) -> _Sweep:
    if not isinstance(study, dict):
        return _Sweep.load(os.fspath(study), target)
    rest = dict(study)
    scene = rest.pop("scene", None)
    if scene is None:
        raise ValueError("a study needs a `scene`, a path or a looselink.Scene")
    if not isinstance(scene, Scene):
        scene = load(scene)
    return _Sweep.of(rest, scene.name, scene.text, scene.overrides, target)


def _shown(progress: bool | Callable[[int, int], object]) -> Callable[[int, int], object] | None:
    if callable(progress):
        return progress
    if not progress:
        return None
    terminal = sys.stderr.isatty()
    tenths = 0

    def show(done: int, left: int) -> None:
        nonlocal tenths
        if terminal:
            print(f"\r{done} of {done + left} runs\033[K", end="" if left else "\n", file=sys.stderr, flush=True)
        elif 10 * done // (done + left) > tenths:
            tenths = 10 * done // (done + left)
            print(f"{done} of {done + left} runs", file=sys.stderr, flush=True)

    return show


def _batches(runs: list[int], size: Callable[[], int]) -> Iterator[list[int]]:
    first = 0
    while first < len(runs):
        last = first + size()
        yield runs[first:last]
        first = last


def _distribute(prepared: _Sweep, client: Any, batch: int | None, shown: Callable[[int, int], object] | None) -> None:
    """Make runs on the workers of a Dask cluster.

    Tasks do not depend on each other: those of a worker that dies are made again by others. Rows are kept by this process as they
    come, so that nothing but the runs under way is lost when it dies.
    """
    from distributed import as_completed

    # a task, not scattered data: a worker that has lost it can make it again
    source = client.submit(_same, prepared.source(), pure=False)
    seconds: list[float] = []

    def size() -> int:
        if batch is not None:
            return batch
        # one run at first; then tasks of about a second
        mean = sum(seconds) / len(seconds) if seconds else 1.0
        return max(1, min(1000, round(1.0 / max(mean, 1e-6))))

    while runs := prepared.pending():
        left = len(runs)
        batches = _batches(runs, size)
        running = as_completed(with_results=True)
        under_way: set[Any] = set()
        looked, wanted = -math.inf, 0

        def start() -> None:
            """Start as many tasks as the workers of this moment need."""
            nonlocal looked, wanted
            if time.monotonic() - looked > LOOK:
                looked = time.monotonic()
                wanted = AHEAD * max(1, sum(client.nthreads().values()))
            while len(under_way) < wanted and (chosen := next(batches, None)) is not None:
                task = client.submit(_make_tasks, __version__, source, prepared.tasks(chosen), pure=False)
                under_way.add(task)
                running.add(task)

        try:
            start()
            while under_way:
                if not running.has_ready():
                    # workers may come while all tasks are long
                    time.sleep(POLL)
                    start()
                    continue
                task, rows = next(running)
                under_way.discard(task)
                if isinstance(rows, BaseException):
                    # the scheduler is lost, or somebody has cancelled the task
                    raise rows
                for row, timing in rows:
                    prepared.append(row, timing)
                    seconds[:] = [*seconds[-99:], json.loads(timing)["wall"]]
                left -= len(rows)
                if shown is not None:
                    shown(prepared.done(), left)
                start()
        except BaseException:
            # a scheduler that is lost has no tasks
            with contextlib.suppress(Exception):
                client.cancel(list(under_way))
            raise


def _same(text: str) -> str:
    return text


def _place(address: str) -> tuple[Any, str]:
    """The file system and the path of an address."""
    try:
        from pyarrow import fs  # type: ignore[import-untyped]
    except ImportError as error:
        raise ImportError("copy_to needs pyarrow: pip install pyarrow") from error
    place, path = fs.FileSystem.from_uri(address)
    return place, path


def _copy(folder: Path, address: str) -> None:
    place, path = _place(address)
    place.create_dir(path, recursive=True)
    # the first file closes a result: without it there is none
    closing, *others = _Sweep.files()
    if place.get_file_info(f"{path}/{closing}").is_file:
        place.delete_file(f"{path}/{closing}")
    for name in [*others, closing]:
        if (folder / name).exists():
            with place.open_output_stream(f"{path}/{name}") as stream:
                stream.write((folder / name).read_bytes())
