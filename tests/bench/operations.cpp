#include "operations.hpp"

#include "integrate/lockstep_includes.hpp"

#define STEERSTAT_ISA counting
#include "pack_counting.hpp"

#include "core/pack_elementary.hpp"

#include "integrate/lockstep_series.hpp"

#include "integrate/lockstep_lanes.hpp"

#include "integrate/lockstep_quiet.hpp"

#include "integrate/lockstep_step.hpp"

namespace steerstat::bench {
namespace {

template <class Work>
Operations count(Work&& work) {
  counting::tally = {};
  work();
  return {counting::tally.in_double, counting::tally.in_single};
}

template <int precision>
StepOperations count_at() {
  using counting::Pack;
  counting::Lanes<precision> packs[1]{};
  counting::Lanes<precision>& lanes = packs[0];
  for (counting::Row* row :
       {&lanes.unit, &lanes.rate, &lanes.t_end, &lanes.scale, &lanes.direction, &lanes.V, &lanes.w}) {
    (*row)[0] = 1.0;  // any numbers: what is done does not depend on them
  }
  counting::LawSeries law{};
  const counting::LoopConstants<Pack> loop{};
  StepOperations operations{};
  operations.series =
      count([&] { counting::expand(loop, law, Pack(0.1), Pack(0.2), Pack(0.3), Pack(0.4), lanes.series); });
  operations.step = count([&] {
    counting::StepReport reports[1];
    counting::advance(packs, -30.0, reports);
  });
  return operations;
}

}  // namespace

StepOperations count_operations(int in_double) {
  return in_double == counting::full ? count_at<counting::full>() : count_at<counting::mixed>();
}

}  // namespace steerstat::bench
