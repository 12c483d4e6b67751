#pragma once

namespace steerstat {

/// How many steps a runner takes between two looks whether it is to go on: 1,024, a few milliseconds.
class CheckInInterval {
 public:
  /// Counts a step. @return whether it is the last of an interval: the runner is to check in
  bool ends_with_step() { return ++steps_ % steps_between == 0; }

 private:
  static constexpr unsigned steps_between = 1024;
  unsigned steps_{0};
};

}  // namespace steerstat
