#include <algorithm>

#include <trocar/studies/handles.hpp>

namespace trocar::studies {

using namespace kinematics;

std::vector<double> start_handles(const Mechanism& m) {
  const std::vector<double> u = m.start_u();
  std::vector<double> handles;
  for (const Drive& d : m.drives) {
    const double way = d.at_1 - d.at_0;
    handles.push_back(way != 0 ? (u[std::size_t(d.independent)] - d.at_0) / way : 0);
  }
  return handles;
}

void set_handles(const Mechanism& m, std::span<const double> handles, std::span<double> u) noexcept {
  for (std::size_t k = 0; k < m.drives.size(); ++k)
    u[std::size_t(m.drives[k].independent)] = m.drives[k].value(handles[k]);
}

void hold_for_study(const Mechanism& m, LoopWork& work) noexcept {
  hold_drives(m, work);
  if (m.rows == 0) std::fill(work.held.begin(), work.held.end(), static_cast<unsigned char>(1));
}

MoveReport move_handles(const Mechanism& m, std::span<const double> handles, std::span<double> u, const Branch& branch,
                        LoopWork& work) {
  std::vector<Target> targets;
  for (std::size_t k = 0; k < m.drives.size(); ++k)
    targets.push_back({m.drives[k].independent, m.drives[k].value(handles[k])});
  return move(m, u, targets, branch, work);
}

}  // namespace trocar::studies
