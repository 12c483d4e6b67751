// Elementary functions of packs, lane by lane the bits of core/elementary.hpp. Included once by a source compiled for
// an instruction set, after its pack; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// sin x and cos x: the bits of steerstat::sincos in every lane.
inline SinCos<Pack> sincos(Pack x) {
  namespace k = elementary;
  const Pack n = round_even(x * Pack(k::two_over_pi));
  const Pack r = fnma(n, Pack(k::half_pi_low), fnma(n, Pack(k::half_pi_high), x));
  const Pack r2 = r * r;
  Pack p(k::sine[0]);
  for (int i = 1; i < 8; ++i) p = fma(p, r2, Pack(k::sine[i]));
  const Pack s = fma(p * r2, r, r);
  Pack q(k::cosine[0]);
  for (int i = 1; i < 8; ++i) q = fma(q, r2, Pack(k::cosine[i]));
  const Pack c = fma(q, r2, Pack(1.0));
  const Pack quadrant = n - Pack(4.0) * floor(n * Pack(0.25));
  const Mask odd = (quadrant == Pack(1.0)) | (quadrant == Pack(3.0));
  const Pack sine = select(odd, c, s);
  const Pack cosine = select(odd, s, c);
  return {select(Pack(2.0) <= quadrant, -sine, sine),
          select((quadrant == Pack(1.0)) | (quadrant == Pack(2.0)), -cosine, cosine)};
}

/// log2 x of a normal x > 0, absolute error below 1.2e-4: enough for a step size.
inline Pack coarse_log2(Pack x) {
  const Pack f = mantissa(x) - Pack(1.0);
  Pack p(-0.07844067620913443);
  p = fma(p, f, Pack(0.31226947732732113));
  p = fma(p, f, Pack(-0.6708826790147842));
  p = fma(p, f, Pack(1.4368748962232516));
  p = fma(p, f, Pack(0.00011457996038222173));
  return exponent(x) + p;
}

/// 2^x for x in [-1000, 1000], relative error below 1e-4: enough for a step size.
inline Pack coarse_exp2(Pack x) {
  const Pack n = round_even(x);
  const Pack f = x - n;
  Pack p(0.05583828294621973);
  p = fma(p, f, Pack(0.24263947854625842));
  p = fma(p, f, Pack(0.6931367338836215));
  p = fma(p, f, Pack(0.9999245569508708));
  return p * two_to(n);
}

}  // namespace steerstat::STEERSTAT_ISA
