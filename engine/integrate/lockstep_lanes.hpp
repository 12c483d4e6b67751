// A pack of trials under way, each with its own plant, law, time and step size. Included once by a source compiled for
// an instruction set, after the series; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// One double a lane.
struct alignas(64) Row {
  double lane[Pack::lanes];
  double& operator[](int i) { return lane[i]; }
  double operator[](int i) const { return lane[i]; }
};
inline Pack load(const Row& row) {
  return load(row.lane);
}
inline void store(Row& row, Pack x) {
  store(row.lane, x);
}

/// The trials under way, a column a lane: state and phase, in the scaled coordinates of LoopConstants.
struct LaneRows {
  Row E, q2, V, w;  ///< state at the step's start
  Row t, t_end;     ///< [s] since the phase's start; where the phase ends unless a guard fires
  Row unit, rate;   ///< the series' unit of time [s], a power of two, and its reciprocal
  Row scale;        ///< 1 / |K|, what a unit of E or V is in m or m/s
  Row kp, kd;       ///< of LawSeries, per second; zero unless aligning
  Row cycle[5];     ///< b = sum of cycle[i] t^(i + 1), t [s] since the phase's start; zero unless in a cycle
  Row radius;       ///< align: the guard's tolerance times |K|; negative: no such guard
  Row ceiling;      ///< align: the bound on |b|; infinite: no such guard
  Row q2_low, q2_high, direction, speed_floor;  ///< drift: the guards of Phase

  // Of the last step: where it began, its size, and how far its velocities strayed from straight lines.
  Row E_start, q2_start, t_start, rate_start;
  Row h;     ///< [s]
  Row bend;  ///< bound on h^2 |second derivative| of the watched velocity (V aligning, else w)
};

template <int precision>
struct Lanes : LaneRows {
  static constexpr bool measured = false;
  LoopConstants<Row> loop;      ///< of the trial, per second
  Expansion<precision> series;  ///< of the last step
};

/// Lanes whose exertion is measured; see lockstep_exertion.hpp.
template <int precision>
struct MeasuredLanes : Lanes<precision> {
  static constexpr bool measured = true;

  ForceSeries<precision> force;  ///< of the last step
  Row done;        ///< [s] how much of it was gone: less than h where a guard fired, 0 where it is retried
  Row force_unit;  ///< (m1 + m2) / |K|, what a unit of the force's series is in N where its unit of time is 1 s
  Row effort, peak_acceleration, peak_force, peak_stroke;  ///< of Exertion
};

/// The growth of the integral of a series over [0, t].
template <int precision>
Pack integral(const Pack (&x)[precision], const Single (&x_short)[order + 1], Pack t, Single t_short) {
  Pack sum(0.0);
  if constexpr (precision < full) {
    Single tail = x_short[order] * Single(1.0 / (order + 1));
    unroll<0, order - precision>([&]<int i>() __attribute__((always_inline)) {
      constexpr int k = order - 1 - i;
      tail = fma(tail, t_short, x_short[k] * Single(1.0 / (k + 1)));
    });
    sum = widen(tail);
  }
  unroll<0, precision>([&]<int i>() __attribute__((always_inline)) {
    constexpr int k = precision - 1 - i;
    sum = k == order ? x[k] * Pack(1.0 / (k + 1)) : fma(sum, t, x[k] * Pack(1.0 / (k + 1)));
  });
  return sum * t;
}

template <int precision>
Pack value(const Pack (&x)[precision], const Single (&x_short)[order + 1], Pack t, Single t_short) {
  Pack sum(0.0);
  if constexpr (precision < full) {
    Single tail = x_short[order];
    unroll<0, order - precision>([&]<int i>() __attribute__((always_inline)) {
      tail = fma(tail, t_short, x_short[order - 1 - i]);
    });
    sum = widen(tail);
  }
  unroll<0, precision>([&]<int i>() __attribute__((always_inline)) {
    constexpr int k = precision - 1 - i;
    sum = k == order ? x[k] : fma(sum, t, x[k]);
  });
  return sum;
}

}  // namespace steerstat::STEERSTAT_ISA
