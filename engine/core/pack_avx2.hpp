// Eight doubles in two AVX2 registers, with FMA. Included once by a source compiled for that instruction set; see
// core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// All bits of a lane set, or none.
struct Mask {
  __m256d a, b;
  friend Mask operator&(Mask x, Mask y) { return {_mm256_and_pd(x.a, y.a), _mm256_and_pd(x.b, y.b)}; }
  friend Mask operator|(Mask x, Mask y) { return {_mm256_or_pd(x.a, y.a), _mm256_or_pd(x.b, y.b)}; }
  friend Mask operator!(Mask x) {
    const __m256d all = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
    return {_mm256_xor_pd(x.a, all), _mm256_xor_pd(x.b, all)};
  }
};

/// Bit i is lane i.
inline std::uint32_t bits(Mask m) {
  return static_cast<std::uint32_t>(_mm256_movemask_pd(m.a)) | static_cast<std::uint32_t>(_mm256_movemask_pd(m.b)) << 4;
}

struct Pack {
  static constexpr int lanes = 8;
  __m256d a, b;

  Pack() = default;
  Pack(__m256d low, __m256d high) : a(low), b(high) {}
  Pack(double x) : a(_mm256_set1_pd(x)), b(a) {}  // NOLINT: numbers convert as they do to double

  friend Pack operator+(Pack x, Pack y) { return {_mm256_add_pd(x.a, y.a), _mm256_add_pd(x.b, y.b)}; }
  friend Pack operator-(Pack x, Pack y) { return {_mm256_sub_pd(x.a, y.a), _mm256_sub_pd(x.b, y.b)}; }
  friend Pack operator*(Pack x, Pack y) { return {_mm256_mul_pd(x.a, y.a), _mm256_mul_pd(x.b, y.b)}; }
  friend Pack operator/(Pack x, Pack y) { return {_mm256_div_pd(x.a, y.a), _mm256_div_pd(x.b, y.b)}; }
  friend Pack operator-(Pack x) {
    const __m256d sign = _mm256_set1_pd(-0.0);
    return {_mm256_xor_pd(x.a, sign), _mm256_xor_pd(x.b, sign)};
  }
  friend Mask operator<(Pack x, Pack y) {
    return {_mm256_cmp_pd(x.a, y.a, _CMP_LT_OQ), _mm256_cmp_pd(x.b, y.b, _CMP_LT_OQ)};
  }
  friend Mask operator<=(Pack x, Pack y) {
    return {_mm256_cmp_pd(x.a, y.a, _CMP_LE_OQ), _mm256_cmp_pd(x.b, y.b, _CMP_LE_OQ)};
  }
  friend Mask operator==(Pack x, Pack y) {
    return {_mm256_cmp_pd(x.a, y.a, _CMP_EQ_OQ), _mm256_cmp_pd(x.b, y.b, _CMP_EQ_OQ)};
  }
};

inline Pack load(const double* p) {
  return {_mm256_load_pd(p), _mm256_load_pd(p + 4)};
}
/// Of any alignment.
inline Pack load_anywhere(const double* p) {
  return {_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4)};
}
inline void store(double* p, Pack x) {
  _mm256_store_pd(p, x.a);
  _mm256_store_pd(p + 4, x.b);
}
/// x y + z, rounded once.
inline Pack fma(Pack x, Pack y, Pack z) {
  return {_mm256_fmadd_pd(x.a, y.a, z.a), _mm256_fmadd_pd(x.b, y.b, z.b)};
}
/// z - x y, rounded once.
inline Pack fnma(Pack x, Pack y, Pack z) {
  return {_mm256_fnmadd_pd(x.a, y.a, z.a), _mm256_fnmadd_pd(x.b, y.b, z.b)};
}
inline Pack abs(Pack x) {
  const __m256d sign = _mm256_set1_pd(-0.0);
  return {_mm256_andnot_pd(sign, x.a), _mm256_andnot_pd(sign, x.b)};
}
inline Pack sqrt(Pack x) {
  return {_mm256_sqrt_pd(x.a), _mm256_sqrt_pd(x.b)};
}
/// y where x is not a number, as the instruction has it.
inline Pack max(Pack x, Pack y) {
  return {_mm256_max_pd(x.a, y.a), _mm256_max_pd(x.b, y.b)};
}
inline Pack min(Pack x, Pack y) {
  return {_mm256_min_pd(x.a, y.a), _mm256_min_pd(x.b, y.b)};
}
inline Pack round_even(Pack x) {
  constexpr int mode = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
  return {_mm256_round_pd(x.a, mode), _mm256_round_pd(x.b, mode)};
}
inline Pack floor(Pack x) {
  return {_mm256_floor_pd(x.a), _mm256_floor_pd(x.b)};
}
/// x where m, else y.
inline Pack select(Mask m, Pack x, Pack y) {
  return {_mm256_blendv_pd(y.a, x.a, m.a), _mm256_blendv_pd(y.b, x.b, m.b)};
}

namespace detail {
inline __m256d exponent(__m256d x) {
  const __m256i field = _mm256_srli_epi64(_mm256_castpd_si256(x), 52);
  const __m256i shifted = _mm256_or_si256(field, _mm256_castpd_si256(_mm256_set1_pd(0x1p52)));
  return _mm256_sub_pd(_mm256_castsi256_pd(shifted), _mm256_set1_pd(0x1p52 + 1023.0));
}
inline __m256d mantissa(__m256d x) {
  const __m256i fraction = _mm256_and_si256(_mm256_castpd_si256(x), _mm256_set1_epi64x(0x000fffffffffffffLL));
  return _mm256_castsi256_pd(_mm256_or_si256(fraction, _mm256_castpd_si256(_mm256_set1_pd(1.0))));
}
inline __m256d two_to(__m256d n) {
  const __m256d shifted = _mm256_add_pd(n, _mm256_set1_pd(0x1p52 + 1023.0));
  return _mm256_castsi256_pd(_mm256_slli_epi64(_mm256_castpd_si256(shifted), 52));
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
  __m256 v;

  Single() = default;
  Single(__m256 x) : v(x) {}
  Single(double x) : v(_mm256_set1_ps(static_cast<float>(x))) {}  // NOLINT: numbers convert as they do to float

  friend Single operator+(Single x, Single y) { return _mm256_add_ps(x.v, y.v); }
  friend Single operator-(Single x, Single y) { return _mm256_sub_ps(x.v, y.v); }
  friend Single operator*(Single x, Single y) { return _mm256_mul_ps(x.v, y.v); }
  friend Mask operator<(Single x, Single y) {
    const __m256i m = _mm256_castps_si256(_mm256_cmp_ps(x.v, y.v, _CMP_LT_OQ));
    return {_mm256_castsi256_pd(_mm256_cvtepi32_epi64(_mm256_castsi256_si128(m))),
            _mm256_castsi256_pd(_mm256_cvtepi32_epi64(_mm256_extracti128_si256(m, 1)))};
  }
};

inline Single fma(Single x, Single y, Single z) {
  return _mm256_fmadd_ps(x.v, y.v, z.v);
}
inline Single fnma(Single x, Single y, Single z) {
  return _mm256_fnmadd_ps(x.v, y.v, z.v);
}
inline Single abs(Single x) {
  return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), x.v);
}
inline Single min(Single x, Single y) {
  return _mm256_min_ps(x.v, y.v);
}
inline Single select(Mask m, Single x, Single y) {
  // The even halves of a's and b's words, in order.
  const __m256 words = _mm256_shuffle_ps(_mm256_castpd_ps(m.a), _mm256_castpd_ps(m.b), _MM_SHUFFLE(2, 0, 2, 0));
  const __m256d ordered = _mm256_permute4x64_pd(_mm256_castps_pd(words), _MM_SHUFFLE(3, 1, 2, 0));
  return _mm256_blendv_ps(y.v, x.v, _mm256_castpd_ps(ordered));
}
/// Rounded to nearest.
inline Single narrow(Pack x) {
  return _mm256_set_m128(_mm256_cvtpd_ps(x.b), _mm256_cvtpd_ps(x.a));
}
/// Exact.
inline Pack widen(Single x) {
  return {_mm256_cvtps_pd(_mm256_castps256_ps128(x.v)), _mm256_cvtps_pd(_mm256_extractf128_ps(x.v, 1))};
}

}  // namespace steerstat::STEERSTAT_ISA
