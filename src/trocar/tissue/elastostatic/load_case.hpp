// The real-time load case: which forces at points of an organ's surface make those points go where what holds, pushes
// and rubs them wants them, given the compliance of the surface                                         [KCM99 eq.7]
//
// At each point y = y0 + s A f, with y0 where it would be without these forces, A the compliance between points (x = W
// q on both sides) and s the share of the answer that a tick brings. What acts there is a spring: f = k (target - y),
// in all directions or along one; an infinite k prescribes the displacement. So (s A + 1/k) f = target - y0, symmetric
// and positive definite. Contacts do not pull: an active set in fixed order, with a bound on its rounds. Loads
// superpose.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

inline constexpr int kMostUnknowns = 240;  ///< forces of a load case
inline constexpr int kMostRounds = 6;      ///< of its active set

/// The compliance of n kept nodes, as it is read: column 3 j + b has the displacements of all under a force of 1 N on
/// node j along axis b [m/N].
struct ComplianceView {
  const float* columns = nullptr;
  int stride = 0;  ///< from column to column, floats
  const float* column(int slot, int axis) const noexcept { return columns + std::ptrdiff_t(3 * slot + axis) * stride; }
};

/// A share of a point's weight.
struct PointTerm {
  std::int32_t slot;  ///< of a kept node
  float weight;
};

/// A spring at a point of the surface, in the organ's own frame.
struct LoadPoint {
  int first = 0, count = 0;  ///< terms
  double give = 0;           ///< 1/k [m/N]; 0: its displacement is prescribed
  Vec3d want;                ///< the displacement at which it pulls no more [m]
  Vec3d dir{0, 0, 0};        ///< unit: it acts along that only; zero: in all directions
  bool one_sided = false;    ///< pushes along dir, never pulls
  Vec3d force{0, 0, 0};      ///< answer: of it on the tissue [N]

  bool along() const noexcept { return dir.x != 0 || dir.y != 0 || dir.z != 0; }
  int unknowns() const noexcept { return along() ? 1 : 3; }
};

/// Scratch. The factor stays for as long as points, directions and springs are the same; what says so is kept by value,
/// so that spoilt scratch is only made again.
struct LoadCaseWork {
  std::vector<double> compliance, factor, turned;  ///< (kMostUnknowns x kMostUnknowns)
  std::vector<double> want, force, gap;            ///< (kMostUnknowns)
  std::vector<std::int32_t> point, axis, active;   ///< (kMostUnknowns) of an unknown; unknowns that take part
  std::vector<double> made_for, asked;             ///< what the factor is of; what is asked now
  int made = 0;                                    ///< unknowns that the factor has

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("compliance", s.compliance), v("factor", s.factor), v("turned", s.turned), v("want", s.want), v("force", s.force),
        v("gap", s.gap), v("point", s.point), v("axis", s.axis), v("active", s.active), v("made_for", s.made_for),
        v("asked", s.asked), v("made", s.made);
  }
};
LoadCaseWork make_load_case_work(int most_terms);

/// @param now     (points) where they are displaced to without the loads' forces [m]
/// @param share   s, 0 to 1
/// Points beyond kMostUnknowns get no force. @return points that were taken
int solve(const ComplianceView& compliance, double share, std::span<const PointTerm> terms, std::span<const Vec3d> now,
          std::span<LoadPoint> points, LoadCaseWork& work) noexcept;

}  // namespace trocar::tissue
