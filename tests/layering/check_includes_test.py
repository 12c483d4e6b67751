#!/usr/bin/env python3
"""Tests of check_includes.py on small trees of its own: each rule is broken once, and kept once."""

import pathlib
import tempfile
import unittest

import check_includes


def problems(path, *includes):
    """The problems of a tree that holds one file with these includes."""
    with tempfile.TemporaryDirectory() as directory:
        root = pathlib.Path(directory)
        (root / "engine").mkdir()
        source = root / path
        source.parent.mkdir(parents=True, exist_ok=True)
        source.write_text("".join(f"#include {include}\n" for include in includes), encoding="utf-8")
        return check_includes.problems_under(root)


class RoomRules(unittest.TestCase):
    def test_a_room_may_not_include_a_room_beside_it(self):
        for room, other in [("robot", "control"), ("control", "robot"), ("sampling", "statistics"),
                            ("statistics", "sampling"), ("control", "integrate"), ("sampling", "robot")]:
            self.assertEqual(len(problems(f"engine/{room}/a.hpp", f'"{other}/b.hpp"')), 1, (room, other))

    def test_a_room_may_not_include_a_room_above_it(self):
        for room, other in [("core", "study"), ("trial", "study"), ("study", "store"), ("study", "report"),
                            ("store", "report"), ("report", "store"), ("sampling", "trial")]:
            self.assertEqual(len(problems(f"engine/{room}/a.cpp", f'"{other}/b.hpp"')), 1, (room, other))

    def test_the_engine_knows_neither_server_nor_command_line(self):
        self.assertEqual(len(problems("engine/report/a.cpp", '"server/routes.hpp"')), 1)
        self.assertEqual(len(problems("engine/report/a.cpp", '"studies/commands.hpp"')), 1)
        self.assertEqual(len(problems("server/a.cpp", '"studies/commands.hpp"')), 1)

    def test_integrate_and_trial_join_robot_and_control(self):
        self.assertEqual(problems("engine/integrate/a.hpp", '"robot/plant.hpp"', '"control/phase.hpp"'), [])
        self.assertEqual(problems("engine/trial/a.hpp", '"robot/plant.hpp"', '"control/phase.hpp"'), [])

    def test_a_room_may_include_itself_and_the_standard_library(self):
        self.assertEqual(problems("engine/robot/a.hpp", '"robot/b.hpp"', '"b.hpp"', "<cmath>"), [])

    def test_programs_may_include_the_whole_engine(self):
        everything = [f'"{room}/a.hpp"' for room in check_includes.ROOMS]
        self.assertEqual(problems("studies/a.cpp", '"server/serve.hpp"', *everything), [])
        self.assertEqual(problems("server/a.cpp", *everything), [])

    def test_a_relative_path_is_no_way_round(self):
        self.assertEqual(len(problems("engine/core/a.hpp", '"../study/run.hpp"')), 1)

    def test_an_unknown_room_is_a_problem(self):
        self.assertEqual(len(problems("engine/attic/a.hpp", "<cmath>")), 1)

    def test_tests_may_include_anything(self):
        self.assertEqual(problems("tests/core/a.cpp", '"study/run.hpp"', "<oneapi/tbb/info.h>"), [])


class LibraryRules(unittest.TestCase):
    def assert_only_in(self, header, allowed, forbidden):
        for path in allowed:
            self.assertEqual(problems(path, header), [], path)
        for path in forbidden:
            self.assertEqual(len(problems(path, header)), 1, path)

    def test_tbb_is_only_in_study_run(self):
        for header in ("<oneapi/tbb/task_arena.h>", "<tbb/parallel_for.h>", "<tbb.h>", "<oneapi/tbb.h>"):
            self.assert_only_in(header, ["engine/study/run.cpp", "engine/study/run.hpp"],
                                ["engine/study/plan.cpp", "engine/study/run/more.cpp", "studies/run.cpp"])

    def test_hdf5_is_only_in_store(self):
        for header in ("<hdf5.h>", "<hdf5_hl.h>", "<H5Cpp.h>", "<H5public.h>"):
            self.assert_only_in(header, ["engine/store/a.cpp"], ["engine/report/a.cpp", "studies/a.cpp"])

    def test_sundials_is_only_in_integrate(self):
        for header in ("<cvode/cvode.h>", "<sundials/sundials_context.h>", "<nvector/nvector_serial.h>",
                       "<sunnonlinsol/sunnonlinsol_fixedpoint.h>", "<arkode/arkode.h>"):
            self.assert_only_in(header, ["engine/integrate/a.cpp"], ["engine/trial/a.cpp", "studies/a.cpp"])

    def test_eigen_is_only_in_sampling(self):
        for header in ("<Eigen/Cholesky>", "<unsupported/Eigen/MatrixFunctions>"):
            self.assert_only_in(header, ["engine/sampling/a.cpp"], ["engine/robot/a.cpp", "studies/a.cpp"])

    def test_json_is_only_in_json_files_and_programs(self):
        self.assert_only_in("<nlohmann/json.hpp>",
                            ["engine/study/spec_json.cpp", "engine/report/summary_json.hpp", "server/a.cpp",
                             "studies/a.cpp"],
                            ["engine/study/study.cpp", "engine/report/json_summary.cpp", "engine/core/json.hpp"])

    def test_boost_is_only_in_statistics(self):
        self.assert_only_in("<boost/math/distributions/binomial.hpp>", ["engine/statistics/a.cpp"],
                            ["engine/report/a.cpp", "studies/a.cpp"])

    def test_mpi_is_only_in_distributed(self):
        self.assert_only_in("<mpi.h>", ["engine/distributed/a.cpp"], ["engine/study/a.cpp", "studies/a.cpp"])

    def test_http_is_only_in_the_server(self):
        self.assert_only_in("<httplib.h>", ["server/a.cpp"], ["engine/core/a.cpp", "studies/a.cpp"])

    def test_the_command_line_parser_is_only_in_studies(self):
        self.assert_only_in("<CLI/CLI.hpp>", ["studies/a.cpp"], ["engine/core/a.cpp", "server/a.cpp"])


if __name__ == "__main__":
    unittest.main()
