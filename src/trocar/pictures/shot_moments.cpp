#include <string_view>

#include <fmt/format.h>

#include <trocar/core/tick.hpp>
#include <trocar/pictures/shot_moments.hpp>

namespace trocar::pictures {

namespace {

constexpr std::uint64_t kTicksPerShot = 20'000;  // where nothing happens

}  // namespace

std::vector<ShotMoment> moments_to_show(const attempt::Session& session, std::uint64_t since) {
  std::vector<ShotMoment> out;
  for (const attempt::Moment& m : session.moments())
    if (std::string_view(m.what) != "closed-empty") out.push_back({m.what, m.text});
  const std::uint64_t tick = session.state().tick;
  if (session.moments().empty() && tick > since && tick % kTicksPerShot == 0)
    out.push_back({"time", fmt::format("after {} s", tick / core::kTicksPerSecond)});
  return out;
}

}  // namespace trocar::pictures
