// A pack of one lane that counts what it does, for counting the operations of the lockstep kernel's formulas. Included
// once, by a source that includes the kernel's parts after it; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// Arithmetic done by packs since it was last set to zero: sums, products and quotients are one operation, fused
/// multiply-adds two; comparisons, choices, signs, conversions and roundings are none.
struct Tally {
  std::uint64_t in_double{0};
  std::uint64_t in_single{0};
};
inline Tally tally;

struct Mask {
  bool m;
  friend Mask operator&(Mask x, Mask y) { return {x.m && y.m}; }
  friend Mask operator|(Mask x, Mask y) { return {x.m || y.m}; }
  friend Mask operator!(Mask x) { return {!x.m}; }
};

inline std::uint32_t bits(Mask m) {
  return m.m ? 1 : 0;
}

/// @tparam Number  double or float
template <class Number>
struct Counted {
  static constexpr int lanes = 1;
  Number v;

  Counted() = default;
  Counted(double x) : v(static_cast<Number>(x)) {}  // NOLINT: numbers convert as they do to double

  static Counted counted(std::uint64_t operations, Number x) {
    (sizeof(Number) == sizeof(double) ? tally.in_double : tally.in_single) += operations;
    return of(x);
  }
  static Counted of(Number x) {
    Counted result;
    result.v = x;
    return result;
  }

  friend Counted operator+(Counted x, Counted y) { return counted(1, x.v + y.v); }
  friend Counted operator-(Counted x, Counted y) { return counted(1, x.v - y.v); }
  friend Counted operator*(Counted x, Counted y) { return counted(1, x.v * y.v); }
  friend Counted operator/(Counted x, Counted y) { return counted(1, x.v / y.v); }
  friend Counted operator-(Counted x) { return of(-x.v); }
  friend Mask operator<(Counted x, Counted y) { return {x.v < y.v}; }
  friend Mask operator<=(Counted x, Counted y) { return {x.v <= y.v}; }
  friend Mask operator==(Counted x, Counted y) { return {!(x.v < y.v) && !(y.v < x.v)}; }
  friend Counted fma(Counted x, Counted y, Counted z) { return counted(2, std::fma(x.v, y.v, z.v)); }
  friend Counted fnma(Counted x, Counted y, Counted z) { return counted(2, std::fma(-x.v, y.v, z.v)); }
  friend Counted abs(Counted x) { return of(std::abs(x.v)); }
  friend Counted max(Counted x, Counted y) { return x.v > y.v ? x : y; }
  friend Counted min(Counted x, Counted y) { return x.v < y.v ? x : y; }
  friend Counted round_even(Counted x) { return of(std::nearbyint(x.v)); }
  friend Counted floor(Counted x) { return of(std::floor(x.v)); }
  friend Counted select(Mask m, Counted x, Counted y) { return m.m ? x : y; }
  /// floor(log2 x) of a normal x > 0, its mantissa, and 2^n of a whole n.
  friend Counted exponent(Counted x) { return of(std::floor(std::log2(x.v))); }
  friend Counted mantissa(Counted x) { return of(x.v / std::exp2(exponent(x).v)); }
};
using Pack = Counted<double>;
using Single = Counted<float>;

inline Pack two_to(Pack n) {
  return std::exp2(n.v);
}
inline Pack load(const double* p) {
  return *p;
}
inline void store(double* p, Pack x) {
  *p = x.v;
}
inline Single narrow(Pack x) {
  return Single::of(static_cast<float>(x.v));
}
inline Pack widen(Single x) {
  return static_cast<double>(x.v);
}

}  // namespace steerstat::STEERSTAT_ISA
