#pragma once

#include <array>
#include <cstddef>

/// Polynomials as arrays of coefficients, lowest power first: p(x) = sum p[k] x^k. All pure and usable in constants.
namespace steerstat {

/// p(x) by Horner's rule. @param p  (N) coefficients, N > 0
template <class Real, std::size_t N>
constexpr Real evaluate(const std::array<double, N>& p, const Real& x) {
  Real sum(p[N - 1]);
  for (std::size_t k = N - 1; k-- > 0;) sum = sum * x + Real(p[k]);
  return sum;
}

/// The integral of p from 0. @return (N + 1) coefficients
template <std::size_t N>
constexpr std::array<double, N + 1> integral(const std::array<double, N>& p) {
  std::array<double, N + 1> result{};
  for (std::size_t k = 0; k < N; ++k) result[k + 1] = p[k] / static_cast<double>(k + 1);
  return result;
}

/// p q. @return (N + M - 1) coefficients
template <std::size_t N, std::size_t M>
constexpr std::array<double, N + M - 1> product(const std::array<double, N>& p, const std::array<double, M>& q) {
  std::array<double, N + M - 1> result{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < M; ++k) result[i + k] += p[i] * q[k];
  }
  return result;
}

}  // namespace steerstat
