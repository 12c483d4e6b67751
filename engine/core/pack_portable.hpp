// Four doubles in plain C++, for machines without AVX2 and FMA. Included once, by a source compiled without any
// instruction set beyond the compiler's default; see core/instruction_set.hpp. std::fma gives it the bits of the
// others, at the price of a library call an operation where the hardware has no fma.

namespace steerstat::STEERSTAT_ISA {

struct Mask {
  std::array<bool, 4> m;
  friend Mask operator&(Mask x, Mask y) {
    for (std::size_t i = 0; i < 4; ++i) x.m[i] = x.m[i] && y.m[i];
    return x;
  }
  friend Mask operator|(Mask x, Mask y) {
    for (std::size_t i = 0; i < 4; ++i) x.m[i] = x.m[i] || y.m[i];
    return x;
  }
  friend Mask operator!(Mask x) {
    for (bool& bit : x.m) bit = !bit;
    return x;
  }
};

/// Bit i is lane i.
inline std::uint32_t bits(Mask m) {
  std::uint32_t word = 0;
  for (std::uint32_t i = 0; i < 4; ++i) word |= m.m[i] ? 1u << i : 0u;
  return word;
}

struct Pack {
  static constexpr int lanes = 4;
  std::array<double, 4> v;

  Pack() = default;
  Pack(double x) : v{x, x, x, x} {}  // NOLINT: numbers convert as they do to double
};

/// The lanes of a Pack in single precision.
struct Single {
  std::array<float, 4> v;

  Single() = default;
  Single(double x) {  // NOLINT: numbers convert as they do to float
    v.fill(static_cast<float>(x));
  }
};

namespace detail {
template <class Function, class Lanes>
Lanes each(Function f, Lanes x) {
  for (auto& value : x.v) value = f(value);
  return x;
}
template <class Function, class Lanes>
Lanes each(Function f, Lanes x, const Lanes& y) {
  for (std::size_t i = 0; i < 4; ++i) x.v[i] = f(x.v[i], y.v[i]);
  return x;
}
template <class Function, class Lanes>
Lanes each(Function f, Lanes x, const Lanes& y, const Lanes& z) {
  for (std::size_t i = 0; i < 4; ++i) x.v[i] = f(x.v[i], y.v[i], z.v[i]);
  return x;
}
template <class Function, class Lanes>
Mask compare(Function f, const Lanes& x, const Lanes& y) {
  Mask m{};
  for (std::size_t i = 0; i < 4; ++i) m.m[i] = f(x.v[i], y.v[i]);
  return m;
}
}  // namespace detail

inline Pack operator+(Pack x, Pack y) {
  return detail::each([](double p, double q) { return p + q; }, x, y);
}
inline Pack operator-(Pack x, Pack y) {
  return detail::each([](double p, double q) { return p - q; }, x, y);
}
inline Pack operator*(Pack x, Pack y) {
  return detail::each([](double p, double q) { return p * q; }, x, y);
}
inline Pack operator/(Pack x, Pack y) {
  return detail::each([](double p, double q) { return p / q; }, x, y);
}
inline Pack operator-(Pack x) {
  return detail::each([](double p) { return -p; }, x);
}
inline Mask operator<(Pack x, Pack y) {
  return detail::compare([](double p, double q) { return p < q; }, x, y);
}
inline Mask operator<=(Pack x, Pack y) {
  return detail::compare([](double p, double q) { return p <= q; }, x, y);
}
inline Mask operator==(Pack x, Pack y) {
  return detail::compare([](double p, double q) { return p == q; }, x, y);
}

inline Pack load(const double* p) {
  Pack x;
  for (std::size_t i = 0; i < 4; ++i) x.v[i] = p[i];
  return x;
}
inline void store(double* p, Pack x) {
  for (std::size_t i = 0; i < 4; ++i) p[i] = x.v[i];
}
/// x y + z, rounded once.
inline Pack fma(Pack x, Pack y, Pack z) {
  return detail::each([](double p, double q, double r) { return std::fma(p, q, r); }, x, y, z);
}
/// z - x y, rounded once.
inline Pack fnma(Pack x, Pack y, Pack z) {
  return detail::each([](double p, double q, double r) { return std::fma(-p, q, r); }, x, y, z);
}
inline Pack abs(Pack x) {
  return detail::each([](double p) { return std::abs(p); }, x);
}
inline Pack sqrt(Pack x) {
  return detail::each([](double p) { return std::sqrt(p); }, x);
}
/// y where x is not a number, as the vector instructions have it.
inline Pack max(Pack x, Pack y) {
  return detail::each([](double p, double q) { return p > q ? p : q; }, x, y);
}
inline Pack min(Pack x, Pack y) {
  return detail::each([](double p, double q) { return p < q ? p : q; }, x, y);
}
inline Pack round_even(Pack x) {
  return detail::each([](double p) { return std::nearbyint(p); }, x);
}
inline Pack floor(Pack x) {
  return detail::each([](double p) { return std::floor(p); }, x);
}
/// x where m, else y.
inline Pack select(Mask m, Pack x, Pack y) {
  for (std::size_t i = 0; i < 4; ++i) x.v[i] = m.m[i] ? x.v[i] : y.v[i];
  return x;
}

/// floor(log2 x) of a normal x > 0.
inline Pack exponent(Pack x) {
  return detail::each(
      [](double p) {
        return static_cast<double>(static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(p) >> 52) - 1023);
      },
      x);
}
/// x / 2^exponent(x), in [1, 2), of a normal x > 0.
inline Pack mantissa(Pack x) {
  return detail::each(
      [](double p) {
        return std::bit_cast<double>((std::bit_cast<std::uint64_t>(p) & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
      },
      x);
}
/// 2^n of a whole n in [-1022, 1023].
inline Pack two_to(Pack n) {
  return detail::each(
      [](double p) { return std::bit_cast<double>(std::bit_cast<std::uint64_t>(p + (0x1p52 + 1023.0)) << 52); }, n);
}

inline Single operator+(Single x, Single y) {
  return detail::each([](float p, float q) { return p + q; }, x, y);
}
inline Single operator-(Single x, Single y) {
  return detail::each([](float p, float q) { return p - q; }, x, y);
}
inline Single operator*(Single x, Single y) {
  return detail::each([](float p, float q) { return p * q; }, x, y);
}
inline Mask operator<(Single x, Single y) {
  return detail::compare([](float p, float q) { return p < q; }, x, y);
}
inline Single fma(Single x, Single y, Single z) {
  return detail::each([](float p, float q, float r) { return std::fma(p, q, r); }, x, y, z);
}
inline Single fnma(Single x, Single y, Single z) {
  return detail::each([](float p, float q, float r) { return std::fma(-p, q, r); }, x, y, z);
}
inline Single abs(Single x) {
  return detail::each([](float p) { return std::abs(p); }, x);
}
inline Single min(Single x, Single y) {
  return detail::each([](float p, float q) { return p < q ? p : q; }, x, y);
}
inline Single select(Mask m, Single x, Single y) {
  for (std::size_t i = 0; i < 4; ++i) x.v[i] = m.m[i] ? x.v[i] : y.v[i];
  return x;
}
/// Rounded to nearest.
inline Single narrow(Pack x) {
  Single y;
  for (std::size_t i = 0; i < 4; ++i) y.v[i] = static_cast<float>(x.v[i]);
  return y;
}
/// Exact.
inline Pack widen(Single x) {
  Pack y;
  for (std::size_t i = 0; i < 4; ++i) y.v[i] = static_cast<double>(x.v[i]);
  return y;
}

}  // namespace steerstat::STEERSTAT_ISA
