// One double in plain C++ as a pack of one lane, for machines without AVX2 and FMA. Included once, by a source compiled
// without any instruction set beyond the compiler's default; see core/instruction_set.hpp. std::fma gives it the bits
// of the others, at the price of a library call an operation where the hardware has no fma. One lane keeps what a step
// works on in registers: it is quicker than four, and compiles in a sixteenth of the time.

namespace steerstat::STEERSTAT_ISA {

struct Mask {
  bool m;
  friend Mask operator&(Mask x, Mask y) { return {x.m && y.m}; }
  friend Mask operator|(Mask x, Mask y) { return {x.m || y.m}; }
  friend Mask operator!(Mask x) { return {!x.m}; }
};

/// Bit i is lane i.
inline std::uint32_t bits(Mask m) {
  return m.m ? 1 : 0;
}

struct Pack {
  static constexpr int lanes = 1;
  double v;

  Pack() = default;
  Pack(double x) : v(x) {}  // NOLINT: numbers convert as they do to double
};

/// The lane of a Pack in single precision.
struct Single {
  float v;

  Single() = default;
  Single(double x) : v(static_cast<float>(x)) {}  // NOLINT: numbers convert as they do to float
};

inline Pack operator+(Pack x, Pack y) {
  return x.v + y.v;
}
inline Pack operator-(Pack x, Pack y) {
  return x.v - y.v;
}
inline Pack operator*(Pack x, Pack y) {
  return x.v * y.v;
}
inline Pack operator/(Pack x, Pack y) {
  return x.v / y.v;
}
inline Pack operator-(Pack x) {
  return -x.v;
}
inline Mask operator<(Pack x, Pack y) {
  return {x.v < y.v};
}
inline Mask operator<=(Pack x, Pack y) {
  return {x.v <= y.v};
}
inline Mask operator==(Pack x, Pack y) {
  return {x.v == y.v};
}

inline Pack load(const double* p) {
  return *p;
}
inline Pack load_anywhere(const double* p) {
  return *p;
}
inline void store(double* p, Pack x) {
  *p = x.v;
}
/// x y + z, rounded once.
inline Pack fma(Pack x, Pack y, Pack z) {
  return std::fma(x.v, y.v, z.v);
}
/// z - x y, rounded once.
inline Pack fnma(Pack x, Pack y, Pack z) {
  return std::fma(-x.v, y.v, z.v);
}
inline Pack abs(Pack x) {
  return std::abs(x.v);
}
inline Pack sqrt(Pack x) {
  return std::sqrt(x.v);
}
/// y where x is not a number, as the vector instructions have it.
inline Pack max(Pack x, Pack y) {
  return x.v > y.v ? x : y;
}
inline Pack min(Pack x, Pack y) {
  return x.v < y.v ? x : y;
}
inline Pack round_even(Pack x) {
  return std::nearbyint(x.v);
}
inline Pack floor(Pack x) {
  return std::floor(x.v);
}
/// x where m, else y.
inline Pack select(Mask m, Pack x, Pack y) {
  return m.m ? x : y;
}

/// floor(log2 x) of a normal x > 0.
inline Pack exponent(Pack x) {
  return static_cast<double>(static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(x.v) >> 52) - 1023);
}
/// x / 2^exponent(x), in [1, 2), of a normal x > 0.
inline Pack mantissa(Pack x) {
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(x.v) & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
}
/// 2^n of a whole n in [-1022, 1023].
inline Pack two_to(Pack n) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(n.v + (0x1p52 + 1023.0)) << 52);
}

inline Single single(float x) {
  Single y;
  y.v = x;
  return y;
}
inline Single operator+(Single x, Single y) {
  return single(x.v + y.v);
}
inline Single operator-(Single x, Single y) {
  return single(x.v - y.v);
}
inline Single operator*(Single x, Single y) {
  return single(x.v * y.v);
}
inline Mask operator<(Single x, Single y) {
  return {x.v < y.v};
}
inline Single fma(Single x, Single y, Single z) {
  return single(std::fma(x.v, y.v, z.v));
}
inline Single fnma(Single x, Single y, Single z) {
  return single(std::fma(-x.v, y.v, z.v));
}
inline Single abs(Single x) {
  return single(std::abs(x.v));
}
inline Single min(Single x, Single y) {
  return x.v < y.v ? x : y;
}
inline Single select(Mask m, Single x, Single y) {
  return m.m ? x : y;
}
/// Rounded to nearest.
inline Single narrow(Pack x) {
  return single(static_cast<float>(x.v));
}
/// Exact.
inline Pack widen(Single x) {
  return static_cast<double>(x.v);
}

}  // namespace steerstat::STEERSTAT_ISA
