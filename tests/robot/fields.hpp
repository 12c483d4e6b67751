#pragma once

#include <utility>

#include "core/state.hpp"
#include "dual.hpp"
#include "robot/linearised.hpp"
#include "robot/plant.hpp"

/// Vector fields as generic functions of the state, with the derivatives and brackets that differential geometry makes
/// of them by automatic differentiation. A field is a callable template: State<Real> -> State<Real>.
namespace steerstat::testing {

template <class Real>
State<Dual<Real>> along(const State<Real>& x, const State<Real>& direction) {
  return {{x.q1, direction.q1}, {x.q2, direction.q2}, {x.q1_dot, direction.q1_dot}, {x.q2_dot, direction.q2_dot}};
}

template <class Real>
State<Real> slope_of(const State<Dual<Real>>& x) {
  return {x.q1.slope, x.q2.slope, x.q1_dot.slope, x.q2_dot.slope};
}

/// The Lie bracket [f, g] = Dg f - Df g, the convention of (6).
template <class F, class G>
auto bracket(F f, G g) {
  return [f, g](const auto& x) {
    const auto along_f = slope_of(g(along(x, f(x))));
    const auto along_g = slope_of(f(along(x, g(x))));
    return decltype(along_f){along_f.q1 - along_g.q1, along_f.q2 - along_g.q2, along_f.q1_dot - along_g.q1_dot,
                             along_f.q2_dot - along_g.q2_dot};
  };
}

/// The directional (Lie) derivative of a scalar function along a field.
template <class F, class Function>
auto derivative_along(F f, Function h) {
  return [f, h](const auto& x) { return h(along(x, f(x))).slope; };
}

/// The robot of (1)-(2) under the linearising force for acceleration `a`, from the plant's own equations.
inline auto steered_plant(PlantParameters<double> plant, double a) {
  return [plant, a]<class Real>(const State<Real>& x) {
    const PlantParameters<Real> p{Real(plant.m1), Real(plant.m2), Real(plant.d2),
                                  Real(plant.I2), Real(plant.f1), Real(plant.f2)};
    const PlantConstants<Real> k = constants_of(p);
    const Real s = sine(x.q2);
    const Real c = cosine(x.q2);
    const auto [q1_ddot, q2_ddot] = accelerations(k, x, s, c, linearising_force(k, Real(a), s, c, x.q2_dot));
    return State<Real>{x.q1_dot, x.q2_dot, q1_ddot, q2_ddot};
  };
}

/// f of (5), as what the plant does without acceleration.
inline auto drift_of(const PlantParameters<double>& plant) {
  return steered_plant(plant, 0.0);
}

/// g of (5), as what a unit of acceleration adds.
inline auto input_of(const PlantParameters<double>& plant) {
  return [with = steered_plant(plant, 1.0), without = steered_plant(plant, 0.0)](const auto& x) {
    const auto b = with(x);
    const auto a = without(x);
    return std::remove_cvref_t<decltype(a)>{b.q1 - a.q1, b.q2 - a.q2, b.q1_dot - a.q1_dot, b.q2_dot - a.q2_dot};
  };
}

}  // namespace steerstat::testing
