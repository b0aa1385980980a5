"""Campaigns, and what the commands compute of them."""

import csv
import os
import pathlib
import shutil
import tempfile
import warnings
import xml.etree.ElementTree

import numpy

from . import _core
from ._errors import InputError, InputWarning
from ._results import Columns, Record, Result

_TABLES = ("circle_sweeps", "wrist_sweep", "rail_sweep", "loading", "states", "displacements", "nests")


def _result(command, computed):
    values, text, warned, why_not, status = computed
    for line in warned:
        warnings.warn(line, InputWarning, stacklevel=3)
    return Result(values, command, text, status == 0, why_not)


def _words(names):
    """One name or several as a list."""
    if names is None:
        return []
    return [names] if isinstance(names, str) else list(names)


def _step(step):
    return "" if step is None else str(step)


def _path(path):
    return "" if path is None else os.fspath(path)


def _refuse(argument, value, expected):
    value = " ".join(str(value).split())  # arrays have lines
    value = value if len(value) <= 60 else value[:57] + "..."
    raise InputError(f"{argument}: '{value}': {expected}", value=value, expected=expected, file=f"--{argument}")


def _floats(argument, values):
    """An array of float; a masked element is NaN."""
    try:
        if numpy.ma.isMaskedArray(values):
            return values.astype(float).filled(numpy.nan)
        if numpy.iscomplexobj(values):
            raise TypeError
        return numpy.asarray(values, dtype=float)
    except (TypeError, ValueError):
        _refuse(argument, values, "expected real numbers, rows of one length")


def _vector(argument, values, size):
    """A vector of finite numbers as a list; [] for None."""
    if values is None:
        return []
    vector = _floats(argument, values)
    if vector.shape != (size,) or not numpy.isfinite(vector).all():
        _refuse(argument, values, f"expected {size} finite numbers")
    return vector.tolist()


def _number(argument, value):
    if value is not None and not numpy.isfinite(value):
        _refuse(argument, value, "expected a finite number")
    return value


def _rows(argument, values, width):
    """An array of rows; one row alone is taken for an array of one."""
    rows = numpy.atleast_2d(_floats(argument, values))
    if rows.ndim != 2 or rows.shape[1] != width:
        _refuse(argument, f"shape {numpy.shape(values)}", f"expected an array of rows of {width} numbers")
    return rows


class Campaign:
    """A measured day in memory: what open() read. Its readings are prepared once for all that is computed of it."""

    def __init__(self, folder_or_xml, *, _kept=True):
        self._core = _core.Campaign(os.fspath(folder_or_xml), _kept)
        self._xml = _xml_of(folder_or_xml).absolute()
        for line in self._core.warnings:
            warnings.warn(line, InputWarning, stacklevel=3)
        self.name = self._core.name
        self.date = self._core.date
        self.robot = self._core.robot
        self.joints = self._core.joints  # how many the machine has
        self.folder = pathlib.Path(self._core.folder)

    def __repr__(self):
        return f"<stiffscope campaign {self.name!r} in {str(self.folder)!r}>"

    def _repr_html_(self):
        import html
        sizes = ", ".join(f"{name}: {len(next(iter(table.values()), ()))} rows" for name, table in self.tables.items())
        return f"<b>{html.escape(self.name)}</b>, {html.escape(self.robot)}, {html.escape(self.date)}<br>{sizes}"

    @property
    def postures(self):
        """Their names, in order of first appearance."""
        return self._core.postures

    @property
    def tables(self):
        """The tables as they were read: by their name in campaign.xml the columns of the campaign format in its units,
        numbers as numpy arrays."""
        return Record((name, Columns(columns)) for name, columns in self._core.tables().items())

    def audit(self):
        return audit(self)

    def frames(self, **options):
        return frames(self, **options)

    def identify(self, **options):
        return identify(self, **options)

    def calibrate(self, **options):
        return calibrate(self, **options)

    def diagnose(self, **options):
        return diagnose(self, **options)

    def compensate(self, postures=None, wrenches=None, **options):
        return compensate(self, postures, wrenches, **options)

    def plan(self, **options):
        return plan(self, **options)


def _xml_of(folder_or_xml):
    path = pathlib.Path(folder_or_xml)
    return path / "campaign.xml" if path.is_dir() else path


def open(folder_or_xml):
    """Reads a campaign folder or its campaign.xml. Each warning about the files is an InputWarning."""
    return Campaign(folder_or_xml)


def _opened(campaign):
    """The campaign in memory; a path is read for one call."""
    return campaign._core if isinstance(campaign, Campaign) else Campaign(campaign, _kept=False)._core


def audit(campaign):
    """Is the day's data fit to identify or to calibrate from? Keys: verdict, checks, suspected, rejected ..."""
    return _result("audit", _core.audit(_opened(campaign)))


def frames(campaign, *, with_=None, springs_only=False, raw=False):
    """Axes, R0, link lengths, P_TCP and the wrist centre from the sweeps."""
    return _result("frames", _core.frames(_opened(campaign), raw, _words(with_), springs_only))


def identify(campaign, *, method="all", step=None, subset_size=None, neglect_kc=False, robust=False, bootstrap=0,
             with_=None, springs_only=False, raw=False):
    """Joint stiffness by Complete, Partial and Decoupled Partial Pose, under methods.cp, .pp and .dpp.

    method: cp, pp, dpp or all; step: a load step's number, or "all"; with_: effects besides joint springs
    ("bearing_tilt:3"), without it those that the data support.
    """
    return _result(
        "identify",
        _core.identify(_opened(campaign), raw, _words(with_), springs_only, method, _step(step), subset_size, bootstrap,
                       neglect_kc, robust))


def calibrate(campaign, *, folds=None, fold_size=None, angles="reported", urdf=None, csv=None, raw=False):
    """Geometry, own weight and effects from unloaded postures, held out; `urdf`, `csv`: files to write."""
    folds = _core.default_folds if folds is None else folds
    fold_size = _core.default_fold_size if fold_size is None else fold_size
    if urdf is not None and csv is not None and os.path.realpath(urdf) == os.path.realpath(csv):
        _refuse("urdf", urdf, "expected another file than csv")
    return _result("calibrate",
                   _core.calibrate(_opened(campaign), raw, folds, fold_size, angles, _path(urdf), _path(csv)))


def compensate(campaign, postures=None, wrenches=None, *, names=None, method="", step=None, with_=None,
               springs_only=False, raw=False):
    """Predicted deflection and the joint commands that cancel it, a row a posture under `rows`.

    postures: an array of rows of joint angles (deg) with `wrenches`, rows of the load cell's expected reading
    (fx, fy, fz in N, mx, my, mz in Nm; one row for all postures will do); or a CSV file of both; or a table of both with
    the file's columns (a dict of arrays or a DataFrame); None: the campaign's own. names: of the postures of an array,
    else 1, 2 ... Angles are those of the campaign's tables: of joints with a joint_reading the controller's figures.
    """
    file, ids, angles, readings = "", None, numpy.zeros((0, 0)), numpy.zeros((0, 6))
    if postures is None or isinstance(postures, (str, os.PathLike)) or hasattr(postures, "keys"):
        # A file and a table have both themselves, and so has the campaign: given beside them they are not ignored.
        for argument, value in (("wrenches", wrenches), ("names", names)):
            if value is not None:
                _refuse(argument, value, "expected together with an array of postures")
    opened = _opened(campaign)
    if postures is not None and (isinstance(postures, (str, os.PathLike))):
        file = os.fspath(postures)
    elif postures is not None:
        if hasattr(postures, "keys"):
            names, postures, wrenches = _posture_table(postures, opened.joints)
        if wrenches is None:
            _refuse("wrenches", None, "expected the load cell's reading of each posture")
        angles = _rows("postures", postures, opened.joints)
        readings = _rows("wrenches", wrenches, 6)
        if len(readings) == 1:
            readings = numpy.repeat(readings, len(angles), axis=0)
        if len(readings) != len(angles):
            _refuse("wrenches", f"{len(readings)} rows", f"expected one row, or one for each of {len(angles)} postures")
        ids = [str(i + 1) for i in range(len(angles))] if names is None else _cells(names)
        if "" in ids:
            _refuse("names", "", "expected a name of each posture")
        if len(ids) != len(angles) or len(set(ids)) != len(ids):
            _refuse("names", f"{len(ids)} names", f"expected {len(angles)} different names")
    return _result(
        "compensate",
        _core.compensate(opened, raw, _words(with_), springs_only, method or "", _step(step), file, ids, angles,
                         readings))


def _posture_table(table, joints):
    angles = [f"q{j}_deg" for j in range(1, joints + 1)]
    wrench = ["fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"]
    missing = [name for name in ["pose", *angles, *wrench] if name not in table.keys()]
    if missing:
        raise InputError(f"postures: {missing[0]}: expected a column of this name", "postures", None, missing[0], None,
                         "expected a column of this name")
    columns = {name: _floats("postures", table[name]) for name in [*angles, *wrench]}
    if {column.shape for column in columns.values()} != {(len(table["pose"]),)}:
        _refuse("postures", table["pose"], "expected columns of one length")
    return (table["pose"], numpy.column_stack([columns[name] for name in angles]),
            numpy.column_stack([columns[name] for name in wrench]))


def compare(before, after, *, step=None, neglect_kc=False, seed=1, with_=None, springs_only=False, raw=False):
    """Two states of one machine: compliances, and deflection avoided; of days without a load, what moved."""
    return _result(
        "compare",
        _core.compare(_opened(before), _opened(after), raw, _words(with_), springs_only, _step(step), neglect_kc, seed))


def diagnose(campaign, *, angles="reported"):
    """What the model misses: where, which effect, how far it shrinks. Keys: verdict, classes, gap, where ..."""
    return _result("diagnose", _core.diagnose(_opened(campaign), angles))


def plan(campaign, *, postures=None, add=None, load=None, pull=None, hook=None, tracker=None, min_deg=None, max_deg=None,
         repeats=None, unloaded=False, criterion="balanced", candidates=None, seed=1, out=None, with_=None,
         springs_only=False):
    """Postures and loads to measure, a row each under `rows`. hook, tracker: x, y, z in mm; min_deg, max_deg: a limit
    of each joint, as the campaign's tables have angles."""
    if postures is not None and add is not None:
        _refuse("add", add, "expected without postures")
    if load is not None and pull is not None:
        _refuse("pull", pull, "expected without load")
    loaded = {"add": add, "load": load, "pull": pull, "hook": hook, "with_": with_}
    given = [name for name, value in loaded.items() if unloaded and value is not None]
    if given or (unloaded and (springs_only or criterion != "balanced")):
        _refuse("unloaded", True, f"expected without {given[0] if given else 'springs_only or criterion'}")
    opened = _opened(campaign)
    return _result(
        "plan",
        _core.plan(opened, _words(with_), springs_only, postures, add, _number("load", load),
                   _number("pull", pull), _vector("hook", hook, 3), _vector("tracker", tracker, 3),
                   _vector("min_deg", min_deg, opened.joints), _vector("max_deg", max_deg, opened.joints),
                   _core.default_repeats if repeats is None else repeats, unloaded, criterion, candidates, seed,
                   _path(out)))


def simulate(spec, out, *, replace=False):
    """Measures a described machine into the campaign folder `out`; returns what the machine truly is (truth.json)."""
    return _result("simulate", _core.simulate(os.fspath(spec), os.fspath(out), replace))


def fit(shape, points, *, strategy="", robust=False):
    """A line, plane, circle, sphere or cylinder through points: an array of rows x, y, z, or a file of them."""
    if isinstance(points, (str, os.PathLike)):
        return _result("fit", _core.fit(shape, os.fspath(points), numpy.zeros((0, 3)), strategy or "", robust))
    return _result("fit", _core.fit(shape, "", _rows("points", points, 3), strategy or "", robust))


def write_campaign(folder, like, tables):
    """Writes a campaign of tables in memory into `folder`, which must not exist, and opens it.

    like    the campaign, its folder or its campaign.xml, whose description and URDF are taken
    tables  by their name in campaign.xml dicts of columns (or DataFrames) as the campaign format has them, in its units;
            NaN and None leave a cell blank. Tables of `like` that are not named come along; None leaves one out

    The tables are read back by the reader of every campaign: what the format does not allow raises InputError with file,
    line and column, and nothing is left behind.
    """
    folder = pathlib.Path(folder)
    if folder.exists():
        raise FileExistsError(f"{folder}: expected a folder that does not exist")
    unknown = [name for name in tables if name not in _TABLES]
    if unknown:
        _refuse("tables", unknown[0], f"expected tables of {', '.join(_TABLES)}")
    source = like._xml if isinstance(like, Campaign) else _xml_of(like)
    with tempfile.TemporaryDirectory(prefix=f".{folder.name}-", dir=folder.absolute().parent) as made:
        inside = pathlib.Path(made) / folder.name
        inside.mkdir()
        _write_folder(inside, source, tables)
        try:
            Campaign(inside, _kept=False)
        except InputError as error:  # the folder that is named in it will not be there
            raise _elsewhere(error, str(inside), str(folder)) from None
        os.replace(inside, folder)
    return Campaign(folder)


def _elsewhere(error, made, meant):
    moved = InputError(str(error).replace(made, meant))
    moved.__dict__.update(error.__dict__)
    moved.file = error.file and error.file.replace(made, meant)
    return moved


def _write_folder(folder, source, tables):
    """A campaign in `folder` of the campaign.xml `source`."""
    document = xml.etree.ElementTree.parse(source)
    root = document.getroot()
    shutil.copyfile(source.parent / root.find("robot").get("urdf"), folder / "robot.urdf")
    root.find("robot").set("urdf", "robot.urdf")
    for name in _TABLES:
        element = root.find(name)
        if name not in tables:
            if element is not None:
                shutil.copyfile(source.parent / element.get("file"), folder / f"{name}.csv")
                element.set("file", f"{name}.csv")
            continue
        if tables[name] is None:
            if element is not None:
                root.remove(element)
            continue
        if element is None:
            element = xml.etree.ElementTree.SubElement(root, name)
        element.set("file", f"{name}.csv")
        _write_table(folder / f"{name}.csv", tables[name])
    document.write(folder / "campaign.xml", encoding="UTF-8", xml_declaration=True)


def _write_table(file, table):
    names = list(table.keys())
    columns = [_cells(table[name]) for name in names]
    if len({len(column) for column in columns}) > 1:
        _refuse("tables", file.stem, "expected columns of one length")
    with file.open("w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(names)
        writer.writerows(zip(*columns))


def _cells(values):
    """Numbers with all their digits; NaN, None, a masked element and pandas' NA as a blank."""
    # A list stays one: as an array of texts its NaN would be the text 'nan'.
    listed = values if isinstance(values, (list, tuple)) else numpy.asanyarray(values).tolist()
    return [_cell(value) for value in listed]


def _cell(value):
    if value is None or value is numpy.ma.masked:
        return ""
    if isinstance(value, (float, numpy.floating)):
        return "" if value != value else repr(float(value))
    if type(value).__name__ in ("NAType", "NaTType"):  # pandas is not imported for them
        return ""
    return str(value)
