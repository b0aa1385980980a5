"""Results as dicts, lists and numpy arrays under the names of the commands' JSON."""

import html

_ROWS_SHOWN = 50  # in a notebook


class Record(dict):
    """An object of a result: a dict whose keys are attributes, too, where they are names in Python (`with` is not)."""

    __slots__ = ()

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"{name!r}; there are {', '.join(map(str, self))}") from None

    def __dir__(self):
        return [*super().__dir__(), *(key for key in self if isinstance(key, str) and key.isidentifier())]


class Rows(list):
    """A list of records; None stands for one that was not determined."""

    __slots__ = ()

    def column(self, name):
        """The values under one name as a numpy array, None as NaN; of names as a list."""
        import numpy

        values = [None if row is None else row.get(name) for row in self]
        if any(isinstance(value, (str, dict, list)) for value in values):
            return values
        shape = next((numpy.shape(value) for value in values if value is not None), ())
        empty = numpy.full(shape, numpy.nan)
        return numpy.array([empty if value is None else value for value in values])

    def table(self):
        """A pandas DataFrame; nested names joined by dots, arrays as one column an element (`q_deg.1`)."""
        return _frame([_flat(row) for row in self if row is not None])

    def _repr_html_(self):
        return _html_table([_flat(row) for row in self if row is not None])


class Columns(dict):
    """A table of a campaign: columns as numpy arrays, names as lists."""

    __slots__ = ()

    def table(self):
        """A pandas DataFrame."""
        return _frame(self)

    def _repr_html_(self):
        rows = len(next(iter(self.values()), ()))
        shown = [{name: values[i] for name, values in self.items()} for i in range(min(rows, _ROWS_SHOWN))]
        return _html_table(shown, rows)


class Result(Record):
    """What a command computed: the JSON of `stiffscope COMMAND --json`, its objects as Record, its lists of objects as
    Rows, its lists of numbers as numpy arrays with NaN for null.

    str(result)     what the command prints
    .serves         whether the result serves its purpose: the command's exit status was 0
    .why_not        why it does not, where the command says so
    .table()        the principal rows as a pandas DataFrame; .table("checks"), .table("summary.refused"): others
    """

    __slots__ = ("_command", "_text", "serves", "why_not")

    def __init__(self, values=(), command="", text="", serves=True, why_not=""):
        super().__init__(values)
        self._command = command
        self._text = text
        self.serves = serves
        self.why_not = why_not

    def __reduce__(self):
        return (Result, (dict(self), self._command, self._text, self.serves, self.why_not))

    def __str__(self):
        return self._text

    def __repr__(self):
        return f"<stiffscope {self._command}: {', '.join(self)}>"

    def _rows(self, path=None):
        if path is not None:
            found = self
            for name in path.split("."):
                if found is None:  # what is part of something that was not determined was not, either
                    return []
                found = found[name]
            return found if isinstance(found, list) else [found]
        return _PRINCIPAL[self._command](self)

    def _why_not(self):
        """Lines for what has no rows."""
        whole = self.why_not or self.get("unavailable") or self.get("reason")
        if whole:
            return [whole]
        methods = self.get("methods", {}).items()
        return [f"{name}: {values['unavailable']}" for name, values in methods if values.get("unavailable")]

    def table(self, path=None):
        return _frame([_flat(row) for row in self._rows(path) if row is not None])

    def _repr_html_(self):
        heading = html.escape(f"{self._command}: {self['campaign']['name']}" if "campaign" in self else self._command)
        notes = "".join(f"<p>{html.escape(line)}</p>" for line in self._why_not())
        return f"<h4>{heading}</h4>{notes}{_html_table([_flat(row) for row in self._rows() if row is not None])}"


def _stiffnesses(result):
    """A row a method and joint; none of a method that is not available."""
    rows = []
    for method, values in result.get("methods", {}).items():
        if "stiffness_nm_per_rad" not in values:
            continue
        for joint in range(len(values["stiffness_nm_per_rad"])):
            low, high = values["interval_nm_per_rad"][joint] if values.get("interval_nm_per_rad") is not None else (
                None, None)
            rows.append({
                "method": method,
                "joint": joint + 1,
                "stiffness_nm_per_rad": values["stiffness_nm_per_rad"][joint],
                "sd_nm_per_rad": values["sd_nm_per_rad"][joint],
                "interval_nm_per_rad.1": low,
                "interval_nm_per_rad.2": high,
                "identifiable": values["identifiable"][joint],
            })
    return rows


def _list_of(name):
    return lambda result: result.get(name) or []


_PRINCIPAL = {
    "audit": _list_of("checks"),
    "frames": _list_of("axes"),
    "identify": _stiffnesses,
    "calibrate": _list_of("axes"),
    "compensate": _list_of("rows"),
    "compare": lambda result: result.get("joints") or result.get("numbers") or [],
    "diagnose": _list_of("classes"),
    "plan": _list_of("rows"),
    "simulate": lambda result: [],
    "fit": lambda result: [result],
}


def _flat(record):
    """One level of names: those of nested records joined by dots, elements of arrays numbered from 1."""
    flat = {}

    def add(name, value):
        if isinstance(value, dict):
            for key, inner in value.items():
                add(f"{name}.{key}" if name else key, inner)
        elif hasattr(value, "shape") and value.shape:
            for i, inner in enumerate(value):
                add(f"{name}.{i + 1}", inner)
        else:
            flat[name] = value

    add("", record)
    return flat


def _frame(data):
    try:
        import pandas
    except ImportError:
        raise ImportError("table() needs pandas (Debian: python3-pandas)") from None
    return pandas.DataFrame(data)


def _cell(value):
    if value is None:
        return ""
    if isinstance(value, float):
        return "" if value != value else f"{value:.6g}"
    return html.escape(", ".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value))


def _html_table(rows, count=None):
    count = len(rows) if count is None else count
    names = list(dict.fromkeys(name for row in rows for name in row))
    if not names:
        return "<p>no rows</p>"
    head = "".join(f"<th>{html.escape(str(name))}</th>" for name in names)
    body = "".join(
        "<tr>" + "".join(f"<td>{_cell(row.get(name))}</td>" for name in names) + "</tr>" for row in rows[:_ROWS_SHOWN])
    more = f"<p>{_ROWS_SHOWN} of {count} rows</p>" if count > _ROWS_SHOWN else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"
