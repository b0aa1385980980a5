"""Results of the module beside the program's JSON: the same names, the same numbers."""

import json
import math
import os
import pathlib
import pickle
import subprocess
import tempfile
import threading
import unittest

import numpy
import stiffscope

SAMPLES = pathlib.Path(os.environ["STIFFSCOPE_SOURCE_DIR"]) / "samples"
PROGRAM = os.environ["STIFFSCOPE_BINARY"]


def printed_json(*words):
    without = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    run = subprocess.run([PROGRAM, *map(str, words), "--json", "-"], stdout=subprocess.PIPE, env=without, check=False)
    return json.loads(run.stdout), run.returncode


def as_json(value):
    """What the module made of a JSON value, as JSON has it again."""
    if isinstance(value, dict):
        return {key: as_json(inner) for key, inner in value.items()}
    if isinstance(value, numpy.ndarray):
        value = value.tolist()
    if isinstance(value, list):
        return [as_json(inner) for inner in value]
    return None if isinstance(value, float) and math.isnan(value) else value


def without_open_rows(value):
    """A list of nothing but null is null: of an array's undetermined rows nothing else is known."""
    if isinstance(value, dict):
        return {key: without_open_rows(inner) for key, inner in value.items()}
    if isinstance(value, list):
        inner = [without_open_rows(one) for one in value]
        return None if inner and all(one is None for one in inner) else inner
    return value


class SameAsTheProgram(unittest.TestCase):
    maxDiff = 2000

    def hold(self, result, *words):
        values, status = printed_json(*words)
        self.assertEqual(without_open_rows(as_json(result)), without_open_rows(values))
        self.assertEqual(result.serves, status == 0)

    def test_audit(self):
        self.hold(stiffscope.audit(SAMPLES / "active"), "audit", SAMPLES / "active")

    def test_frames(self):
        self.hold(stiffscope.frames(SAMPLES / "active", springs_only=True), "frames", SAMPLES / "active", "--springs-only")

    def test_identify(self):
        self.hold(stiffscope.identify(SAMPLES / "active"), "identify", SAMPLES / "active")

    def test_identify_with_options(self):
        self.hold(stiffscope.identify(SAMPLES / "active", method="pp", step=2, springs_only=True, neglect_kc=True, raw=True,
                                      robust=True, bootstrap=20, subset_size=12),
                  "identify", SAMPLES / "active", "--method", "pp", "--step", "2", "--springs-only", "--neglect-kc", "--raw",
                  "--robust", "--bootstrap", "20", "--subset-size", "12")

    def test_compensate(self):
        self.hold(stiffscope.compensate(SAMPLES / "active", springs_only=True), "compensate", SAMPLES / "active",
                  "--springs-only")

    def test_calibrate(self):
        self.hold(stiffscope.calibrate(SAMPLES / "unloaded", folds=3), "calibrate", SAMPLES / "unloaded", "--folds", "3")

    def test_diagnose(self):
        self.hold(stiffscope.diagnose(SAMPLES / "unloaded"), "diagnose", SAMPLES / "unloaded")

    def test_compare(self):
        self.hold(stiffscope.compare(SAMPLES / "inactive", SAMPLES / "active", springs_only=True), "compare",
                  SAMPLES / "inactive", SAMPLES / "active", "--springs-only")

    def test_plan(self):
        self.hold(stiffscope.plan(SAMPLES / "active", springs_only=True, postures=4, candidates=100, load=900,
                                  hook=[0, 100, 300]),
                  "plan", SAMPLES / "active", "--springs-only", "--postures", "4", "--candidates", "100", "--load", "900",
                  "--hook", "0,100,300")

    def test_fit(self):
        angle = numpy.linspace(0, 5, 12)
        points = numpy.column_stack([20 + 3 * numpy.cos(angle), 7 + 3 * numpy.sin(angle), 0.001 * numpy.cos(3 * angle)])
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "points.txt"
            file.write_text("".join(" ".join(map(repr, row)) + "\n" for row in points.tolist()))
            self.hold(stiffscope.fit("circle", points), "fit", "circle", file)
            self.assertEqual(as_json(stiffscope.fit("circle", points)), as_json(stiffscope.fit("circle", file)))


class Shapes(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.day = stiffscope.open(SAMPLES / "active")
        cls.found = cls.day.identify(springs_only=True)

    def test_numbers_are_arrays_and_null_is_nan(self):
        pp = self.found.methods.pp
        self.assertEqual(pp.stiffness_nm_per_rad.shape, (6,))
        self.assertEqual(pp.stiffness_nm_per_rad.dtype, numpy.float64)
        self.assertTrue(numpy.isnan(pp.stiffness_nm_per_rad[0]))
        self.assertEqual(pp.interval_nm_per_rad.shape, (6, 2))
        self.assertTrue(numpy.isnan(pp.interval_nm_per_rad[0]).all())
        self.assertTrue((pp.interval_nm_per_rad[1:, 0] < pp.stiffness_nm_per_rad[1:]).all())
        self.assertEqual(pp.identifiable.dtype, bool)
        self.assertEqual(pp.correlation.shape, (6, 6))

    def test_rows_as_columns_and_tables(self):
        self.assertEqual(len(self.found.per_posture.column("wrist_mm")), len(self.day.postures))
        self.assertIsInstance(self.found.per_posture.column("pose"), list)
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not here")
        table = self.found.table()
        self.assertIsInstance(table, pandas.DataFrame)
        self.assertEqual(len(table), 18)  # three methods, six joints
        self.assertIn("interval_nm_per_rad.2", table)
        self.assertEqual(len(self.found.table("per_posture")), 19)
        self.assertEqual(self.day.tables.states.table().shape[1], 15)

    def test_notebooks_get_html_and_terminals_text(self):
        self.assertIn("<table>", self.found._repr_html_())
        self.assertIn("<table>", self.day.tables.loading._repr_html_())
        self.assertIn("50 of ", self.day.tables.loading._repr_html_())
        self.assertIn("Stiffness, 1e6 Nm/rad", str(self.found))
        self.assertIn("active", self.day._repr_html_())

    def test_a_method_that_is_not_available_has_no_rows(self):
        with tempfile.TemporaryDirectory() as folder:
            day = stiffscope.write_campaign(pathlib.Path(folder) / "day", SAMPLES / "active", {"wrist_sweep": None})
            found = day.identify(springs_only=True)
            page = found._repr_html_()
            alone = day.identify(springs_only=True, method="dpp")
            nothing = stiffscope.write_campaign(pathlib.Path(folder) / "sweeps", SAMPLES / "active",
                                                {"loading": None, "states": None, "nests": None})
            shown = [result._repr_html_() for result in (nothing.identify(), nothing.diagnose(), nothing.calibrate())]
        self.assertIn("unavailable", found.methods.dpp)
        self.assertEqual([row["method"] for row in found._rows()], ["cp"] * 6 + ["pp"] * 6)
        self.assertIn("<table>", page)
        self.assertIn("<p>dpp: ", page)
        self.assertEqual(alone._rows(), [])
        self.assertIn("<p>dpp: ", alone._repr_html_())
        for one in shown:
            self.assertIn("states", one)  # what is missing
            self.assertIn("no rows", one)
        self.assertEqual(stiffscope.Result({"summary": None})._rows("summary.refused"), [])

    def test_results_survive_pickling(self):
        again = pickle.loads(pickle.dumps(self.found))
        self.assertEqual(as_json(again), as_json(self.found))
        self.assertEqual(str(again), str(self.found))
        self.assertTrue(again.serves)

    def test_threads_compute_at_the_same_time_and_alike(self):
        day = stiffscope.open(SAMPLES / "active")
        results = [None] * 4

        def work(i):
            results[i] = day.identify(springs_only=True)

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            self.assertEqual(as_json(result), as_json(self.found))

    def test_nothing_is_printed(self):
        code = ("import stiffscope, sys; day = stiffscope.open(sys.argv[1]); day.audit(); day.frames(springs_only=True); "
                "day.identify(springs_only=True)")
        run = subprocess.run([os.sys.executable, "-c", code, str(SAMPLES / "active")], capture_output=True, check=True)
        self.assertEqual((run.stdout, run.stderr), (b"", b""))


if __name__ == "__main__":
    unittest.main()
