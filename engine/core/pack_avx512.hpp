// Sixteen doubles in two AVX-512 registers. Included once by a source compiled for that instruction set; see
// core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// One bit a lane.
struct Mask {
  __mmask8 a, b;
  friend Mask operator&(Mask x, Mask y) { return {static_cast<__mmask8>(x.a & y.a), static_cast<__mmask8>(x.b & y.b)}; }
  friend Mask operator|(Mask x, Mask y) { return {static_cast<__mmask8>(x.a | y.a), static_cast<__mmask8>(x.b | y.b)}; }
  friend Mask operator!(Mask x) { return {static_cast<__mmask8>(~x.a), static_cast<__mmask8>(~x.b)}; }
};

/// Bit i is lane i.
inline std::uint32_t bits(Mask m) {
  return static_cast<std::uint32_t>(m.a) | static_cast<std::uint32_t>(m.b) << 8;
}

struct Pack {
  static constexpr int lanes = 16;
  __m512d a, b;

  Pack() = default;
  Pack(__m512d low, __m512d high) : a(low), b(high) {}
  Pack(double x) : a(_mm512_set1_pd(x)), b(a) {}  // NOLINT: numbers convert as they do to double

  friend Pack operator+(Pack x, Pack y) { return {_mm512_add_pd(x.a, y.a), _mm512_add_pd(x.b, y.b)}; }
  friend Pack operator-(Pack x, Pack y) { return {_mm512_sub_pd(x.a, y.a), _mm512_sub_pd(x.b, y.b)}; }
  friend Pack operator*(Pack x, Pack y) { return {_mm512_mul_pd(x.a, y.a), _mm512_mul_pd(x.b, y.b)}; }
  friend Pack operator/(Pack x, Pack y) { return {_mm512_div_pd(x.a, y.a), _mm512_div_pd(x.b, y.b)}; }
  friend Pack operator-(Pack x) {
    const __m512i sign = _mm512_set1_epi64(std::numeric_limits<std::int64_t>::min());
    return {_mm512_castsi512_pd(_mm512_xor_epi64(_mm512_castpd_si512(x.a), sign)),
            _mm512_castsi512_pd(_mm512_xor_epi64(_mm512_castpd_si512(x.b), sign))};
  }
  friend Mask operator<(Pack x, Pack y) {
    return {_mm512_cmp_pd_mask(x.a, y.a, _CMP_LT_OQ), _mm512_cmp_pd_mask(x.b, y.b, _CMP_LT_OQ)};
  }
  friend Mask operator<=(Pack x, Pack y) {
    return {_mm512_cmp_pd_mask(x.a, y.a, _CMP_LE_OQ), _mm512_cmp_pd_mask(x.b, y.b, _CMP_LE_OQ)};
  }
  friend Mask operator==(Pack x, Pack y) {
    return {_mm512_cmp_pd_mask(x.a, y.a, _CMP_EQ_OQ), _mm512_cmp_pd_mask(x.b, y.b, _CMP_EQ_OQ)};
  }
};

inline Pack load(const double* p) {
  return {_mm512_load_pd(p), _mm512_load_pd(p + 8)};
}
/// Of any alignment.
inline Pack load_anywhere(const double* p) {
  return {_mm512_loadu_pd(p), _mm512_loadu_pd(p + 8)};
}
inline void store(double* p, Pack x) {
  _mm512_store_pd(p, x.a);
  _mm512_store_pd(p + 8, x.b);
}
/// x y + z, rounded once.
inline Pack fma(Pack x, Pack y, Pack z) {
  return {_mm512_fmadd_pd(x.a, y.a, z.a), _mm512_fmadd_pd(x.b, y.b, z.b)};
}
/// z - x y, rounded once.
inline Pack fnma(Pack x, Pack y, Pack z) {
  return {_mm512_fnmadd_pd(x.a, y.a, z.a), _mm512_fnmadd_pd(x.b, y.b, z.b)};
}
inline Pack abs(Pack x) {
  return {_mm512_abs_pd(x.a), _mm512_abs_pd(x.b)};
}
inline Pack sqrt(Pack x) {
  return {_mm512_sqrt_pd(x.a), _mm512_sqrt_pd(x.b)};
}
/// y where x is not a number, as the instruction has it.
inline Pack max(Pack x, Pack y) {
  return {_mm512_max_pd(x.a, y.a), _mm512_max_pd(x.b, y.b)};
}
inline Pack min(Pack x, Pack y) {
  return {_mm512_min_pd(x.a, y.a), _mm512_min_pd(x.b, y.b)};
}
inline Pack round_even(Pack x) {
  constexpr int mode = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
  return {_mm512_roundscale_pd(x.a, mode), _mm512_roundscale_pd(x.b, mode)};
}
inline Pack floor(Pack x) {
  constexpr int mode = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
  return {_mm512_roundscale_pd(x.a, mode), _mm512_roundscale_pd(x.b, mode)};
}
/// x where m, else y.
inline Pack select(Mask m, Pack x, Pack y) {
  return {_mm512_mask_blend_pd(m.a, y.a, x.a), _mm512_mask_blend_pd(m.b, y.b, x.b)};
}

namespace detail {
inline __m512d exponent(__m512d x) {
  const __m512i field = _mm512_srli_epi64(_mm512_castpd_si512(x), 52);
  const __m512i shifted = _mm512_or_epi64(field, _mm512_castpd_si512(_mm512_set1_pd(0x1p52)));
  return _mm512_sub_pd(_mm512_castsi512_pd(shifted), _mm512_set1_pd(0x1p52 + 1023.0));
}
inline __m512d mantissa(__m512d x) {
  const __m512i fraction = _mm512_and_epi64(_mm512_castpd_si512(x), _mm512_set1_epi64(0x000fffffffffffffLL));
  return _mm512_castsi512_pd(_mm512_or_epi64(fraction, _mm512_castpd_si512(_mm512_set1_pd(1.0))));
}
inline __m512d two_to(__m512d n) {
  const __m512d shifted = _mm512_add_pd(n, _mm512_set1_pd(0x1p52 + 1023.0));
  return _mm512_castsi512_pd(_mm512_slli_epi64(_mm512_castpd_si512(shifted), 52));
}
}  // namespace detail

/// floor(log2 x) of a normal x > 0.
inline Pack exponent(Pack x) {
  return {detail::exponent(x.a), detail::exponent(x.b)};
}
/// x / 2^exponent(x), in [1, 2), of a normal x > 0.
inline Pack mantissa(Pack x) {
  return {detail::mantissa(x.a), detail::mantissa(x.b)};
}
/// 2^n of a whole n in [-1022, 1023].
inline Pack two_to(Pack n) {
  return {detail::two_to(n.a), detail::two_to(n.b)};
}

/// The lanes of a Pack in single precision, in one register.
struct Single {
  __m512 v;

  Single() = default;
  Single(__m512 x) : v(x) {}
  Single(double x) : v(_mm512_set1_ps(static_cast<float>(x))) {}  // NOLINT: numbers convert as they do to float

  friend Single operator+(Single x, Single y) { return _mm512_add_ps(x.v, y.v); }
  friend Single operator-(Single x, Single y) { return _mm512_sub_ps(x.v, y.v); }
  friend Single operator*(Single x, Single y) { return _mm512_mul_ps(x.v, y.v); }
  friend Mask operator<(Single x, Single y) {
    const __mmask16 m = _mm512_cmp_ps_mask(x.v, y.v, _CMP_LT_OQ);
    return {static_cast<__mmask8>(m), static_cast<__mmask8>(m >> 8)};
  }
};

inline Single fma(Single x, Single y, Single z) {
  return _mm512_fmadd_ps(x.v, y.v, z.v);
}
inline Single fnma(Single x, Single y, Single z) {
  return _mm512_fnmadd_ps(x.v, y.v, z.v);
}
inline Single abs(Single x) {
  return _mm512_abs_ps(x.v);
}
inline Single min(Single x, Single y) {
  return _mm512_min_ps(x.v, y.v);
}
inline Single select(Mask m, Single x, Single y) {
  return _mm512_mask_blend_ps(static_cast<__mmask16>(m.a | m.b << 8), y.v, x.v);
}
/// Rounded to nearest.
inline Single narrow(Pack x) {
  return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(x.a)), _mm512_cvtpd_ps(x.b), 1);
}
/// Exact.
inline Pack widen(Single x) {
  return {_mm512_cvtps_pd(_mm512_castps512_ps256(x.v)), _mm512_cvtps_pd(_mm512_extractf32x8_ps(x.v, 1))};
}

}  // namespace steerstat::STEERSTAT_ISA
