#include "sidestep/planner/objective/obstacle_kernels.h"

#include <limits>

// Highway compiles what follows once for each instruction set, each time in a namespace of its own;
// the end of the file picks one of them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sidestep/planner/objective/obstacle_kernels.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sidestep::planner::obstacle_kernels {
namespace HWY_NAMESPACE {
namespace {  // position-independent code inlines nothing that others could replace
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kGroup>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr std::size_t kLanes = hn::MaxLanes(D());
static_assert(kGroup % kLanes == 0);

struct Vector {
  V x, y, z;
};

V Constant(double value) { return hn::Set(D(), value); }

Vector Load3(const double* from_8) {
  const D d;
  return {hn::Load(d, from_8), hn::Load(d, from_8 + kGroup), hn::Load(d, from_8 + 2 * kGroup)};
}
void Store3(const Vector& v, double* to_8) {
  const D d;
  hn::Store(v.x, d, to_8);
  hn::Store(v.y, d, to_8 + kGroup);
  hn::Store(v.z, d, to_8 + 2 * kGroup);
}
Vector Times(const Vector& v, V factor) {
  return {hn::Mul(v.x, factor), hn::Mul(v.y, factor), hn::Mul(v.z, factor)};
}
Vector Plus(const Vector& a, const Vector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
Vector Minus(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
Vector Cross(const Vector& a, const Vector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
V Dot(const Vector& a, const Vector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
Vector Choose(M condition, const Vector& yes, const Vector& no) {
  return {hn::IfThenElse(condition, yes.x, no.x), hn::IfThenElse(condition, yes.y, no.y),
          hn::IfThenElse(condition, yes.z, no.z)};
}

V Polynomial(V) { return hn::Zero(D()); }
template <class... Rest>
V Polynomial(V x, double first, Rest... rest) {
  return hn::Add(Constant(first), hn::Mul(x, Polynomial(x, rest...)));
}

// To 1e-15 for |x| < 1e5; beyond 1e9 whatever, within [-1.1, 1.1]. Coefficients: the kernels of
// FreeBSD's msun (k_sin.c, k_cos.c; Sun Microsystems, freely given); pi / 2 in three parts, the
// first two short enough for exact products.
void SinCos(V x, V& sin, V& cos) {
  const D d;
  const V turns = hn::Round(hn::Mul(x, Constant(0.63661977236758134308)));
  V r = hn::Sub(x, hn::Mul(turns, Constant(1.57079632673412561417e+00)));
  r = hn::Sub(r, hn::Mul(turns, Constant(6.07710050630396597660e-11)));
  r = hn::Sub(r, hn::Mul(turns, Constant(2.02226624879595063154e-21)));
  r = hn::Min(hn::Max(r, Constant(-0.8)), Constant(0.8));
  const V r2 = hn::Mul(r, r);
  const V s =
      hn::Add(r, hn::Mul(hn::Mul(r, r2),
                         Polynomial(r2, -1.66666666666666324348e-01, 8.33333333332248946124e-03,
                                    -1.98412698298579493134e-04, 2.75573137070700676789e-06,
                                    -2.50507602534068634195e-08, 1.58969099521155010221e-10)));
  const V c =
      hn::Add(hn::Sub(Constant(1), hn::Mul(Constant(0.5), r2)),
              hn::Mul(hn::Mul(r2, r2),
                      Polynomial(r2, 4.16666666666666019037e-02, -1.38888888888741095749e-03,
                                 2.48015872894767294178e-05, -2.75573143513906633035e-07,
                                 2.08757232129817482790e-09, -1.13596475577881948265e-11)));
  // Of a quarter turn, whether its number is odd, and whether the half turn it lies in is.
  const auto is_odd = [](V number) {
    const V half = hn::Mul(number, Constant(0.5));
    return hn::Gt(hn::Sub(half, hn::Floor(half)), Constant(0.25));
  };
  const auto half_turn = [&](V number) {
    return is_odd(hn::Floor(hn::Mul(number, Constant(0.5))));
  };
  const M swap = is_odd(turns);
  const V sin_part = hn::IfThenElse(swap, c, s), cos_part = hn::IfThenElse(swap, s, c);
  sin = hn::IfThenElse(half_turn(turns), hn::Neg(sin_part), sin_part);
  cos = hn::IfThenElse(half_turn(hn::Add(turns, hn::Set(d, 1.0))), hn::Neg(cos_part), cos_part);
}

struct Frame {
  Vector x, y, z, p;
};

Vector OfFrame(const Frame& frame, double x, double y, double z) {
  return Plus(Plus(Times(frame.x, Constant(x)), Times(frame.y, Constant(y))),
              Times(frame.z, Constant(z)));
}

// The frame of a row's joint from that of its parent.
void Move(const robot::KinematicRow& row, Frame& frame) {
  const auto& R = row.R_PA;
  const auto& p = row.p_PA;
  frame.p = Plus(frame.p, OfFrame(frame, p(0), p(1), p(2)));
  const Vector x = OfFrame(frame, R(0, 0), R(1, 0), R(2, 0));
  const Vector y = OfFrame(frame, R(0, 1), R(1, 1), R(2, 1));
  frame.z = OfFrame(frame, R(0, 2), R(1, 2), R(2, 2));
  frame.x = x;
  frame.y = y;
}

// Stores what the coordinate of a row does to its frame.
void StoreAxis(const robot::KinematicRow& row, const Frame& frame, double* axis_8) {
  const V factor = Constant(row.multiplier);
  if (row.slides) {
    const V zero = hn::Zero(D());
    Store3({zero, zero, zero}, axis_8);
    Store3(Times(frame.z, hn::Neg(factor)), axis_8 + 3 * kGroup);
    return;
  }
  Store3(Times(frame.z, factor), axis_8);
  Store3(Times(Cross(frame.z, frame.p), factor), axis_8 + 3 * kGroup);
}

// The frame K of a row from that of its joint.
void Advance(const robot::KinematicRow& row, V q, Frame& frame) {
  const V position = hn::Add(hn::Mul(q, Constant(row.multiplier)), Constant(row.offset));
  V theta = Constant(row.theta_rad), distance = Constant(row.d_m);
  if (row.slides) {
    distance = hn::Add(position, distance);
  } else {
    theta = hn::Add(position, theta);
  }
  V s, c;
  SinCos(theta, s, c);
  const Vector x = Plus(Times(frame.x, c), Times(frame.y, s));
  const Vector y = Minus(Times(frame.y, c), Times(frame.x, s));
  frame.p = Plus(frame.p, Plus(Times(frame.z, distance), Times(x, Constant(row.a_m))));
  const V ca = Constant(row.cos_alpha), sa = Constant(row.sin_alpha);
  frame.x = x;
  frame.y = Plus(Times(y, ca), Times(frame.z, sa));
  frame.z = Minus(Times(frame.z, ca), Times(y, sa));
}

// RobotModel::ComputeSphereCenters, for the lanes that begin at `lane`.
void CentersOfLanes(const Arm& arm, std::size_t lane, const double* q_8, double* axes_8,
                    double* centers_8) {
  const D d;
  const auto& R = arm.R_WB;
  const Frame base = {{Constant(R[0]), Constant(R[3]), Constant(R[6])},
                      {Constant(R[1]), Constant(R[4]), Constant(R[7])},
                      {Constant(R[2]), Constant(R[5]), Constant(R[8])},
                      {Constant(arm.p_WB[0]), Constant(arm.p_WB[1]), Constant(arm.p_WB[2])}};
  int sphere = 0;
  const auto place_spheres = [&](const Frame& frame, int end) {
    for (; sphere < end; ++sphere) {
      const auto& at = arm.spheres[static_cast<std::size_t>(sphere)].p_KS;
      Store3(Plus(frame.p, OfFrame(frame, at[0], at[1], at[2])),
             centers_8 + 3 * kGroup * static_cast<std::size_t>(sphere) + lane);
    }
  };
  place_spheres(base, arm.end_base_sphere);

  Frame frames[robot::kMaxRows];
  Frame frame = base;
  const int num_rows = static_cast<int>(arm.rows.size());
  for (int i = 0; i < num_rows; ++i) {
    const Arm::Row& row = arm.rows[static_cast<std::size_t>(i)];
    const robot::KinematicRow& joint = row.joint;
    if (joint.parent != i - 1) frame = joint.parent < 0 ? base : frames[joint.parent];
    if (joint.is_moved) Move(joint, frame);
    if (axes_8 != nullptr) {
      StoreAxis(joint, frame,
                axes_8 + kNumbersPerAxis * kGroup * static_cast<std::size_t>(i) + lane);
    }
    const auto coordinate = static_cast<std::size_t>(joint.coordinate);
    Advance(joint, hn::Load(d, q_8 + kGroup * coordinate + lane), frame);
    frames[i] = frame;
    place_spheres(frame, row.end_sphere);
  }
}

void CentersOfGroup(const Arm& arm, const double* q_8, double* axes_8, double* centers_8) {
  for (std::size_t lane = 0; lane < kGroup; lane += kLanes) {
    CentersOfLanes(arm, lane, q_8, axes_8, centers_8);
  }
}

// What the hinges of some configurations, one a lane, add up to.
class Sums {
 public:
  Sums(const Arm& arm, const double* axes_8) : n_(arm.num_joints), axes_8_(axes_8) {
    cost_ = hn::Zero(D());
    for (int j = 0; j < n_; ++j) gradient_[j] = hn::Zero(D());
    for (int h = 0; h < n_ * (n_ + 1) / 2; ++h) hessian_[h] = hn::Zero(D());
  }

  // A hinge whose slope in the position of its point `p` is `slope`.
  void Add(V hinge, const Vector& p, const Vector& slope, const Arm::Movers& movers) {
    V J[kMaxJoints];
    Begin(movers, J);
    AddSlope(p, slope, movers, J);
    AddHinge(hinge, movers.coordinates, J);
  }

  // A hinge of the gap between two points, whose slope in the position of the second is `slope`.
  void AddGap(V hinge, const Vector& first, const Vector& second, const Vector& slope,
              const Arm::LinkHinge& links) {
    V J[kMaxJoints];
    Begin(links.of_second, J);
    AddSlope(second, slope, links.of_second, J);
    AddSlope(first, Times(slope, Constant(-1)), links.of_first, J);
    AddHinge(hinge, links.of_second.coordinates, J);
  }

  void Store(double* terms_8) const {
    const D d;
    hn::Store(hn::Mul(Constant(0.5), cost_), d, terms_8);
    terms_8 += kGroup;
    for (int j = 0; j < n_; ++j, terms_8 += kGroup) hn::Store(gradient_[j], d, terms_8);
    for (int h = 0; h < n_ * (n_ + 1) / 2; ++h, terms_8 += kGroup) {
      hn::Store(hessian_[h], d, terms_8);
    }
  }

 private:
  // J has an entry for each coordinate of the movers.
  static void Begin(const Arm::Movers& movers, V* J) {
    for (std::size_t k = 0; k < movers.coordinates.size(); ++k) J[k] = hn::Zero(D());
  }

  void AddSlope(const Vector& p, const Vector& slope, const Arm::Movers& movers, V* J) const {
    const Vector torque = Cross(p, slope);
    for (const Arm::Mover& mover : movers.rows) {
      const double* const axis =
          axes_8_ + kNumbersPerAxis * kGroup * static_cast<std::size_t>(mover.row);
      J[mover.index] = hn::Add(
          J[mover.index], hn::Sub(Dot(Load3(axis), torque), Dot(Load3(axis + 3 * kGroup), slope)));
    }
  }

  void AddHinge(V hinge, const std::vector<int>& coordinates, const V* J) {
    cost_ = hn::Add(cost_, hn::Mul(hinge, hinge));
    const std::size_t count = coordinates.size();
    for (std::size_t k = 0; k < count; ++k) {
      V& gradient = gradient_[coordinates[k]];
      gradient = hn::Add(gradient, hn::Mul(J[k], hinge));
    }
    for (std::size_t a = 0; a < count; ++a) {
      V* const row = hessian_ + coordinates[a] * (coordinates[a] + 1) / 2;
      for (std::size_t b = 0; b <= a; ++b) {
        row[coordinates[b]] = hn::Add(row[coordinates[b]], hn::Mul(J[a], J[b]));
      }
    }
  }

  int n_;
  const double* axes_8_;
  V cost_;
  V gradient_[kMaxJoints];
  V hessian_[kMaxJoints * (kMaxJoints + 1) / 2];
};

void AddLinkHinge(const Arm& arm, const Arm::LinkHinge& links, const double* centers_8,
                  Sums& sums) {
  const D d;
  const V margin = Constant(arm.self_epsilon_m);
  V least = margin;
  Vector apart = {hn::Zero(d), hn::Zero(d), hn::Zero(d)}, nearest_first = apart,
         nearest_second = apart;
  V inverse = hn::Zero(d);
  bool any = false;
  for (const Arm::SpherePair& pair : links.pairs) {
    const auto center = [&](int sphere) {
      return Load3(centers_8 + 3 * kGroup * static_cast<std::size_t>(sphere));
    };
    const Vector first = center(pair.first), second = center(pair.second);
    const Vector between = Minus(second, first);
    const V square = Dot(between, between);
    // A little more than the hinge's reach: the root decides.
    const double reach_m =
        1.000001 * (arm.self_epsilon_m + pair.first_radius_m + pair.second_radius_m);
    if (hn::AllFalse(d, hn::Lt(square, Constant(reach_m * reach_m)))) continue;
    const V norm = hn::Sqrt(square);
    const V gap =
        hn::Sub(hn::Sub(norm, Constant(pair.first_radius_m)), Constant(pair.second_radius_m));
    const M nearer = hn::Lt(gap, least);
    least = hn::IfThenElse(nearer, gap, least);
    apart = Choose(nearer, between, apart);
    nearest_first = Choose(nearer, first, nearest_first);
    nearest_second = Choose(nearer, second, nearest_second);
    const M distinct = hn::Gt(norm, hn::Zero(d));
    const V one_over = hn::Div(Constant(1), hn::IfThenElse(distinct, norm, Constant(1)));
    inverse = hn::IfThenElse(nearer, one_over, inverse);
    any = true;
  }
  if (!any) return;
  const V hinge = hn::Mul(hn::Sub(margin, least), Constant(arm.inverse_sigma));
  const Vector slope = Times(apart, hn::Mul(inverse, Constant(-arm.inverse_sigma)));
  sums.AddGap(hinge, nearest_first, nearest_second, slope, links);
}

void TermsOfGroup(const Arm& arm, const double* axes_8, const double* centers_8,
                  const double* samples_8, double* terms_8) {
  const D d;
  const V inverse_sigma = Constant(arm.inverse_sigma);
  for (std::size_t lane = 0; lane < kGroup; lane += kLanes) {
    Sums sums(arm, axes_8 + lane);
    const double* sample = samples_8 + lane;
    for (const Arm::Hinge& hinge : arm.hinges) {
      const V missing = hn::Sub(Constant(hinge.reach_m), hn::Load(d, sample));
      const Vector gradient = Load3(sample + kGroup);
      sample += 4 * kGroup;
      const M active = hn::Gt(missing, hn::Zero(d));
      if (hn::AllFalse(d, active)) continue;
      const V value = hn::IfThenElseZero(active, hn::Mul(missing, inverse_sigma));
      const V slope = hn::IfThenElseZero(active, hn::Neg(inverse_sigma));
      sums.Add(value, Load3(centers_8 + 3 * kGroup * static_cast<std::size_t>(hinge.sphere) + lane),
               Times(gradient, slope), arm.movers[static_cast<std::size_t>(hinge.movers)]);
    }
    for (const Arm::LinkHinge& links : arm.link_hinges) {
      AddLinkHinge(arm, links, centers_8 + lane, sums);
    }
    sums.Store(terms_8 + lane);
  }
}

void ClearanceOfGroup(const Arm& arm, const double* centers_8, const double* samples_8,
                      double* clearance_8) {
  const D d;
  for (std::size_t lane = 0; lane < kGroup; lane += kLanes) {
    V least = Constant(std::numeric_limits<double>::infinity());
    const double* sample = samples_8 + lane;
    for (const Arm::Hinge& hinge : arm.hinges) {
      least = hn::Min(least, hn::Sub(hn::Load(d, sample), Constant(hinge.radius_m)));
      sample += 4 * kGroup;
    }
    for (const Arm::LinkHinge& links : arm.link_hinges) {
      for (const Arm::SpherePair& pair : links.pairs) {
        const auto center = [&](int sphere) {
          return Load3(centers_8 + 3 * kGroup * static_cast<std::size_t>(sphere) + lane);
        };
        const Vector between = Minus(center(pair.second), center(pair.first));
        const V square = Dot(between, between);
        // A little more than where it would be the least: the root decides.
        const V reach =
            hn::Mul(Constant(1.000001),
                    hn::Max(hn::Add(least, Constant(pair.first_radius_m + pair.second_radius_m)),
                            hn::Zero(d)));
        if (hn::AllFalse(d, hn::Le(square, hn::Mul(reach, reach)))) continue;
        const V gap = hn::Sub(hn::Sub(hn::Sqrt(square), Constant(pair.first_radius_m)),
                              Constant(pair.second_radius_m));
        least = hn::Min(least, gap);
      }
    }
    hn::Store(least, d, clearance_8 + lane);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sidestep::planner::obstacle_kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sidestep::planner::obstacle_kernels {

HWY_EXPORT(CentersOfGroup);
HWY_EXPORT(TermsOfGroup);
HWY_EXPORT(ClearanceOfGroup);

void ComputeCenters(const Arm& arm, const double* q_8, double* axes_8, double* centers_8) {
  HWY_DYNAMIC_DISPATCH(CentersOfGroup)(arm, q_8, axes_8, centers_8);
}

void ComputeTerms(const Arm& arm, const double* axes_8, const double* centers_8,
                  const double* samples_8, double* terms_8) {
  HWY_DYNAMIC_DISPATCH(TermsOfGroup)(arm, axes_8, centers_8, samples_8, terms_8);
}

void ComputeClearance(const Arm& arm, const double* centers_8, const double* samples_8,
                      double* clearance_8) {
  HWY_DYNAMIC_DISPATCH(ClearanceOfGroup)(arm, centers_8, samples_8, clearance_8);
}

}  // namespace sidestep::planner::obstacle_kernels
#endif  // HWY_ONCE
