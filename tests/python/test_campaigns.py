"""Campaigns of tables in memory, and postures and points as arrays."""

import json
import os
import pathlib
import shutil
import tempfile
import unittest

import numpy
import stiffscope

SAMPLES = pathlib.Path(os.environ["STIFFSCOPE_SOURCE_DIR"]) / "samples"


class Tables(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.day = stiffscope.open(SAMPLES / "active")

    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)

    def test_columns_are_those_of_the_files(self):
        lines = (SAMPLES / "active" / "loading.csv").read_text().splitlines()
        loading = self.day.tables.loading
        self.assertEqual(list(loading), lines[0].split(","))
        self.assertEqual(len(loading["x_mm"]), len(lines) - 1)
        first = dict(zip(lines[0].split(","), lines[1].split(",")))
        # Millimetres to metres and back is exact to some units in the last place.
        self.assertAlmostEqual(loading["x_mm"][0], float(first["x_mm"]), delta=1e-9)
        self.assertEqual(loading["target"][0], first["target"])
        self.assertEqual(loading["step"][0], int(first["step"]))

    def test_a_campaign_of_tables_in_memory_is_the_same_day(self):
        again = stiffscope.write_campaign(self.folder / "again", self.day, self.day.tables)
        for name, table in self.day.tables.items():
            for column, values in table.items():
                if isinstance(values, list):
                    self.assertEqual(values, again.tables[name][column])
                else:
                    numpy.testing.assert_allclose(again.tables[name][column], values, rtol=1e-14, atol=1e-12)
        before = self.day.identify(springs_only=True, method="pp").methods.pp
        after = again.identify(springs_only=True, method="pp").methods.pp
        # Roundings of 1e-16 of a reading grow with the condition of the fit and where steps end.
        numpy.testing.assert_allclose(after.stiffness_nm_per_rad, before.stiffness_nm_per_rad, rtol=1e-6)

    def test_a_table_that_is_changed_changes_the_result(self):
        states = dict(self.day.tables.states)
        for name in ("fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"):
            states[name] = 2 * states[name]
        twice = stiffscope.write_campaign(self.folder / "twice", SAMPLES / "active", {"states": states, "nests": None})
        self.assertNotIn("nests", twice.tables)
        before = self.day.identify(springs_only=True, method="pp", neglect_kc=True).methods.pp.stiffness_nm_per_rad
        after = twice.identify(springs_only=True, method="pp", neglect_kc=True).methods.pp.stiffness_nm_per_rad
        # Linear springs: twice the load for the same displacement. K_c is neglected; the sag of the sweeps is not doubled.
        numpy.testing.assert_allclose(after[1:] / before[1:], 2.0, rtol=0.02)

    def test_what_the_format_refuses_leaves_nothing_behind(self):
        loading = dict(self.day.tables.loading)
        loading["x_mm"] = loading["x_mm"].copy()
        loading["x_mm"][3] = 1e9
        with self.assertRaises(stiffscope.InputError) as raised:
            stiffscope.write_campaign(self.folder / "spoilt", self.day, {"loading": loading})
        error = raised.exception
        self.assertEqual((error.line, error.column), (5, "x_mm"))
        self.assertEqual(error.file, str(self.folder / "spoilt" / "loading.csv"))
        self.assertIn("within +-200 m", error.expected)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_an_existing_folder_is_not_written_over(self):
        (self.folder / "mine").mkdir()
        with self.assertRaises(FileExistsError):
            stiffscope.write_campaign(self.folder / "mine", self.day, {})

    def test_none_and_nan_are_blanks_in_every_column(self):
        states = dict(self.day.tables.states)
        count = len(states["pose"])
        for blank in (None, float("nan")):
            states["temperature_c"] = [blank, 21.5] + [20] * (count - 2)
            again = stiffscope.write_campaign(self.folder / f"again-{blank}", self.day, {"states": states})
            numpy.testing.assert_array_equal(again.tables.states["temperature_c"][:3], [numpy.nan, 21.5, 20.0])
        masked = numpy.ma.masked_array(numpy.full(count, 20.0), mask=[True] + [False] * (count - 1))
        states["temperature_c"] = masked
        again = stiffscope.write_campaign(self.folder / "again-masked", self.day, {"states": states})
        self.assertTrue(numpy.isnan(again.tables.states["temperature_c"][0]))
        # A name that is missing is no name.
        nests = dict(self.day.tables.nests)
        for blank in (None, float("nan")):
            nests["nest"] = [blank if i == 3 else name for i, name in enumerate(self.day.tables.nests["nest"])]
            with self.assertRaises(stiffscope.InputError) as raised:
                stiffscope.write_campaign(self.folder / "nameless", self.day, {"nests": nests})
            self.assertEqual((raised.exception.line, raised.exception.column), (5, "nest"))

    def test_the_description_is_that_which_was_opened(self):
        folder = self.folder / "two"
        shutil.copytree(SAMPLES / "active", folder)
        xml = (folder / "campaign.xml").read_text()
        at = xml.index('date="') + len('date="')
        (folder / "later.xml").write_text(xml[:at] + "2030-01-02" + xml[at + len("2030-01-02"):])
        later = stiffscope.open(folder / "later.xml")
        self.assertEqual(later.date, "2030-01-02")
        self.assertEqual(stiffscope.write_campaign(self.folder / "by_day", later, {}).date, "2030-01-02")
        self.assertEqual(stiffscope.write_campaign(self.folder / "by_path", folder / "later.xml", {}).date, "2030-01-02")
        self.assertNotEqual(stiffscope.write_campaign(self.folder / "by_folder", folder, {}).date, "2030-01-02")

    def test_what_an_earlier_call_read_is_written_anew(self):
        for _ in range(2):
            stiffscope.simulate(SAMPLES / "unloaded.xml", self.folder / "day", replace=True)
            stiffscope.open(self.folder / "day")
        planned = self.folder / "plan.csv"
        for _ in range(2):
            self.day.plan(postures=3, candidates=60, springs_only=True, out=planned)
            self.day.compensate(planned, springs_only=True)

    def test_no_call_writes_over_the_campaign_that_it_is_given(self):
        shutil.copytree(SAMPLES / "active", self.folder / "mine")
        measured = self.folder / "mine" / "states.csv"
        before = measured.read_bytes()
        day = stiffscope.open(self.folder / "mine")
        self.day.audit()
        for campaign in (day, self.folder / "mine"):
            with self.assertRaisesRegex(RuntimeError, "it is an input of this run"):
                stiffscope.plan(campaign, postures=3, candidates=60, springs_only=True, out=measured)
        self.assertEqual(measured.read_bytes(), before)

    def test_simulate_writes_a_day(self):
        truth = stiffscope.simulate(SAMPLES / "active.xml", self.folder / "day")
        self.assertEqual(truth.stiffness_nm_per_rad.shape, (6,))
        self.assertEqual(list(truth), list(json.loads((self.folder / "day" / "truth.json").read_text())))
        self.assertEqual(stiffscope.open(self.folder / "day").postures, self.day.postures)


def rail_day(folder):
    """A short day of the samples' arm on a rail of six metres."""
    urdf = (SAMPLES / "m900ib700.urdf").read_text()
    rail = ('<link name="floor"/><joint name="rail" type="prismatic"><parent link="floor"/><child link="base_link"/>'
            '<axis xyz="1 0 0"/><limit lower="0" upper="6" effort="0" velocity="0"/></joint>')
    (folder / "rail.urdf").write_text(urdf.replace('<link name="base_link">', rail + '<link name="base_link">', 1))
    spec = (SAMPLES / "active.xml").read_text()
    for old, new in (('urdf="m900ib700.urdf" base_link="base_link"', 'urdf="rail.urdf" base_link="floor"'),
                     ('readings="1000"', 'readings="60"'), ('<draw count="19"', '<draw count="6"'),
                     ("<postures>", '<rail min_mm="0" max_mm="600" stops="5"/>\n  <postures>')):
        assert old in spec, old
        spec = spec.replace(old, new, 1)
    (folder / "rail.xml").write_text(spec)
    stiffscope.simulate(folder / "rail.xml", folder / "rail")
    return folder / "rail"


class Rail(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(made.cleanup)
        cls.folder = pathlib.Path(made.name)
        cls.files = rail_day(cls.folder)
        cls.day = stiffscope.open(cls.files)

    def test_the_sweep_of_the_carriage_is_a_table(self):
        lines = (self.files / "rail_sweep.csv").read_text().splitlines()
        names = lines[0].split(",")
        rows = [dict(zip(names, line.split(","))) for line in lines[1:]]
        sweep = self.day.tables.rail_sweep
        self.assertEqual(list(sweep), names)
        self.assertEqual(len(rows), 5 * 3)
        self.assertEqual(list(sweep["target"]), [row["target"] for row in rows])
        self.assertEqual(list(sweep["index"]), [row["index"] for row in rows])
        for column in ("rail_mm", "x_mm", "y_mm", "z_mm"):
            numpy.testing.assert_allclose(sweep[column], [float(row[column]) for row in rows], rtol=0, atol=1e-9)
        self.assertEqual((min(sweep["rail_mm"]), max(sweep["rail_mm"])), (0.0, 600.0))

    def test_it_is_written_again_and_is_what_refers_the_readings(self):
        tables = dict(self.day.tables)
        again = stiffscope.write_campaign(self.folder / "again", self.day, tables)
        for column, values in self.day.tables.rail_sweep.items():
            if isinstance(values, list):
                self.assertEqual(again.tables.rail_sweep[column], values)
            else:
                numpy.testing.assert_allclose(again.tables.rail_sweep[column], values, rtol=1e-14, atol=1e-12)
        # A carriage that went half as far as it says.
        sweep = dict(tables["rail_sweep"])
        sweep["rail_mm"] = 2 * sweep["rail_mm"]
        wrong = stiffscope.write_campaign(self.folder / "wrong", self.day, {"rail_sweep": sweep})

        def scale(day):
            return next(check for check in day.audit().checks if check.id == "rail_scale")

        self.assertEqual(scale(again).verdict, "pass")
        self.assertEqual(scale(wrong).verdict, "fail")

    def test_without_it_a_carriage_that_moved_is_refused(self):
        with self.assertRaises(stiffscope.InputError) as raised:
            stiffscope.write_campaign(self.folder / "without", self.day, {"rail_sweep": None})
        self.assertIn("rail_sweep", str(raised.exception))
        self.assertFalse((self.folder / "without").exists())


class Postures(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.day = stiffscope.open(SAMPLES / "active")
        states = cls.day.tables.states
        heavy = numpy.flatnonzero(states["step"] == 3)[:3]
        cls.names = [states["pose"][i] for i in heavy]
        cls.angles = numpy.column_stack([states[f"q{j}_deg"][heavy] for j in range(1, 7)])
        cls.wrenches = numpy.column_stack([states[n][heavy] for n in ("fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm")])

    def test_arrays_table_and_file_are_the_same(self):
        by_arrays = self.day.compensate(self.angles, self.wrenches, names=self.names, springs_only=True)
        columns = {"pose": self.names}
        columns.update({f"q{j + 1}_deg": self.angles[:, j] for j in range(6)})
        columns.update(dict(zip(("fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"), self.wrenches.T)))
        by_table = self.day.compensate(columns, springs_only=True)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "postures.csv"
            rows = zip(*([str(v) for v in values] if isinstance(values, list) else map(repr, values.tolist())
                         for values in columns.values()))
            file.write_text(",".join(columns) + "\n" + "".join(",".join(row) + "\n" for row in rows))
            by_file = self.day.compensate(file, springs_only=True)
        own = self.day.compensate(springs_only=True)
        for i in range(3):
            for other in (by_table, by_file):
                self.assertEqual(other.rows[i].pose, by_arrays.rows[i].pose)
                numpy.testing.assert_array_equal(other.rows[i].tcp_deflection_mm, by_arrays.rows[i].tcp_deflection_mm)
            # The same posture among the campaign's own: what is rounded in the tables' units moves by 1e-16.
            numpy.testing.assert_allclose(own.rows[i].tcp_deflection_mm, by_arrays.rows[i].tcp_deflection_mm, rtol=1e-9)

    def test_angles_are_the_controllers_figures(self):
        """Joint 3 against the horizontal, as the tables of such a day have it: the same arm, the same postures."""
        forces = ("fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm")
        figures = self.angles.copy()
        figures[:, 2] -= figures[:, 1]
        columns = {"pose": self.names, **{f"q{j + 1}_deg": figures[:, j] for j in range(6)},
                   **dict(zip(forces, self.wrenches.T))}
        with tempfile.TemporaryDirectory() as made:
            folder = pathlib.Path(made)
            shutil.copytree(SAMPLES / "active", folder / "like")
            description = folder / "like" / "campaign.xml"
            reading = '<joint_reading joint="3" plus="2"/>'
            description.write_text(description.read_text().replace("<tool ", reading + "<tool ", 1))
            tables = {}
            for name in ("circle_sweeps", "wrist_sweep", "states"):
                tables[name] = dict(self.day.tables[name])
                tables[name]["q3_deg"] = tables[name]["q3_deg"] - tables[name]["q2_deg"]
            day = stiffscope.write_campaign(folder / "day", folder / "like", tables)
            file = folder / "postures.csv"
            lines = [",".join(columns)] + [",".join(map(str, row)) for row in zip(
                self.names, *(map(repr, columns[name].tolist()) for name in list(columns)[1:]))]
            file.write_text("\n".join(lines) + "\n")
            by_file = day.compensate(file, springs_only=True)
        by_arrays = day.compensate(figures, self.wrenches, names=self.names, springs_only=True)
        by_table = day.compensate(columns, springs_only=True)
        plain = self.day.compensate(self.angles, self.wrenches, names=self.names, springs_only=True)
        for i in range(3):
            for other in (by_arrays, by_table):
                for key in ("q_deg", "tcp_deflection_mm", "command_deg"):
                    numpy.testing.assert_array_equal(other.rows[i][key], by_file.rows[i][key])
            numpy.testing.assert_allclose(by_arrays.rows[i].q_deg, self.angles[i], rtol=0, atol=1e-8)
            numpy.testing.assert_allclose(by_arrays.rows[i].tcp_deflection_mm, plain.rows[i].tcp_deflection_mm, rtol=0,
                                          atol=1e-3)
        self.assertEqual(str(by_arrays), str(by_file))

    def test_one_wrench_serves_all_postures(self):
        rows = self.day.compensate(self.angles, [0, 0, -1000, 0, 0, 0], springs_only=True).rows
        self.assertEqual([row.pose for row in rows], ["1", "2", "3"])


if __name__ == "__main__":
    unittest.main()
