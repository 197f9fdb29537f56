#include <memory>
#include <string>

#include <fmt/format.h>

#include <trocar/attempt/progress.hpp>
#include <trocar/core/log.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::attempt {

void Progress::at(std::uint64_t tick) {
  if (tick % 256 != 0) return;  // a look at the clock costs, too
  const Clock::time_point now = Clock::now();
  if (now - m_told < std::chrono::seconds(5)) return;
  m_told = now;
  const double wall = std::chrono::duration<double>(now - m_start).count();
  const double simulated = double(tick - m_first) * sim::kTick;
  const std::string whole = m_last > 0 ? fmt::format(" of {:.1f} s", double(m_last - m_first) * sim::kTick) : "";
  core::log::info("{:.1f} s{} simulated in {:.1f} s (x{:.2f})", simulated, whole, wall, simulated / wall);
}

std::function<void(const std::string&, double)> told_of_solvers() {
  using Clock = std::chrono::steady_clock;
  auto told = std::make_shared<Clock::time_point>(Clock::now());
  return [told](const std::string& organ, double share) {
    if (Clock::now() - *told < std::chrono::seconds(2)) return;
    *told = Clock::now();
    core::log::info("making the static solver of '{}': {:.0f} %", organ, 100 * share);
  };
}

}  // namespace trocar::attempt
