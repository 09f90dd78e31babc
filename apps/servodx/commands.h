// The subcommands. Each adds itself with its options; its callback does the work and sets the exit code.
#pragma once

namespace CLI {
class App;
}

namespace servodx {

void add_simulate_command(CLI::App& app);
void add_tune_command(CLI::App& app, int& exit_code);
void add_sensitivity_command(CLI::App& app, int& exit_code);
void add_baseline_command(CLI::App& app, int& exit_code);
void add_diagnose_command(CLI::App& app, int& exit_code);
void add_plan_command(CLI::App& app, int& exit_code);
void add_gather_command(CLI::App& app, int& exit_code);
void add_watch_command(CLI::App& app, int& exit_code);
void add_join_command(CLI::App& app);
void add_explain_command(CLI::App& app, int& exit_code);
void add_monitor_command(CLI::App& app);
void add_check_command(CLI::App& app, int& exit_code);
void add_trend_command(CLI::App& app);
void add_history_command(CLI::App& app, int& exit_code);
void add_list_command(CLI::App& app);
void add_map_command(CLI::App& app);
void add_curves_command(CLI::App& app);
void add_check_log_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_init_command(CLI::App& app);
void add_selftest_command(CLI::App& app);
void add_rerun_command(CLI::App& app, int& exit_code);
void add_manual_commands(CLI::App& app);  // help, completion, man: made from what the other commands say of themselves

}  // namespace servodx
