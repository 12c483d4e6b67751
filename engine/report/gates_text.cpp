#include "report/gates_text.hpp"

#include <fmt/color.h>
#include <fmt/format.h>

#include "report/readable.hpp"
#include "report/text_table.hpp"

namespace steerstat {
namespace {

using Align = TextTable::Align;

constexpr std::size_t most_gates = 30;

fmt::text_style style_of(Verdict verdict) {
  if (verdict == Verdict::pass) return fg(fmt::terminal_color::green);
  return fg(verdict == Verdict::fail ? fmt::terminal_color::red : fmt::terminal_color::yellow) | fmt::emphasis::bold;
}

}  // namespace

std::string gates_text(const std::vector<GateVerdict>& gates, bool colour) {
  TextTable table({{"Verdict", Align::left}, {"Gate", Align::left}, {"Value"}, {"Why", Align::left}});
  std::size_t passed = 0;
  std::size_t shown = 0;
  for (const GateVerdict& gate : gates) {
    const bool is_pass = gate.verdict == Verdict::pass;
    passed += is_pass ? 1U : 0U;
    if (gates.size() > most_gates && (is_pass || ++shown > most_gates)) continue;
    table.add_row({{std::string(name_of(gate.verdict)), style_of(gate.verdict)},
                   {gate_title(gate)},
                   {gate.value ? fmt::format("{:.6g}", *gate.value) : no_data},
                   {gate.reason, faint}});
  }
  std::string text = table.text(colour);
  if (gates.size() > most_gates) {
    text += styled(fmt::format("  {} of {} gates passed; the JSON summary has them all.\n", readable_count(passed),
                               readable_count(gates.size())),
                   faint, colour);
  }
  return text;
}

}  // namespace steerstat
