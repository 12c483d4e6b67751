#pragma once

#include <CLI/CLI.hpp>

#include "exit_code.hpp"

namespace steerstat {

// Each adds one command to `program`: its options, its help, and as its callback what it does. The callback stores the
// exit code in `exit_code`, which must outlive `program`, or throws BadUsage, BadSpec (exit 2) or RunFailure (exit 4).

void add_run(CLI::App& program, ExitCode& exit_code);
void add_validate(CLI::App& program, ExitCode& exit_code);
void add_show(CLI::App& program, ExitCode& exit_code);
void add_replay(CLI::App& program, ExitCode& exit_code);
void add_export(CLI::App& program, ExitCode& exit_code);
void add_merge(CLI::App& program, ExitCode& exit_code);
void add_compare(CLI::App& program, ExitCode& exit_code);
void add_report(CLI::App& program, ExitCode& exit_code);
void add_serve(CLI::App& program, ExitCode& exit_code);

}  // namespace steerstat
