#include <algorithm>

#include <trocar/interactions/instrument/linkage_works.hpp>

namespace trocar::interactions {

kinematics::Frame at_handle(const LinkageWorks::Part& part, double handle) noexcept {
  const double place = std::clamp(handle, 0.0, 1.0) * kLinkageSteps;
  const int step = std::min(int(place), kLinkageSteps - 1);
  const double share = place - step;
  const kinematics::Frame &a = part.at[std::size_t(step)], &b = part.at[std::size_t(step) + 1];
  const Vec3d turn = share * kinematics::turn_between(a.r, b.r);
  const double angle = length(turn);
  const Mat3d r = angle > 0 ? kinematics::turn_about(turn / angle, angle) * a.r : a.r;
  return {r, a.p + share * (b.p - a.p)};
}

}  // namespace trocar::interactions
