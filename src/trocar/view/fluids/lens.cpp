#include <algorithm>
#include <cmath>

#include <trocar/core/tick.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/fluids/lens.hpp>

namespace trocar::view {
namespace {

constexpr double kDropPath = 15e-6;  // [m] of liquid that light crosses in a drop on the lens
constexpr double kSmearTau = 6;      // [s] a smear thins out
constexpr double kSmearLeft = 0.45;  // by a wipe
constexpr float kSwabAngle = 0.5f;   // [rad] the way it is drawn across
constexpr float kStrokes = 3;        // of a wipe, to and fro

}  // namespace

void Lens::splash(double strength, const fluids::Mix& mix, std::uint32_t seed) {
  const double all = double(std::max<std::int64_t>(mix.total(), 1));
  const fluids::Shares shares{double(mix.blood) / all, double(mix.bile) / all, 0.98};
  const fluids::Rgb tint = fluids::transmission({}, shares, kDropPath);
  // A drop on the lens is thin at its edge and lit from all around: paler than its depth says (our choice).
  const Vec3f drop_tint{float(0.35 + 0.65 * tint.r), float(0.35 + 0.65 * tint.g), float(0.35 + 0.65 * tint.b)};
  const int n = int(std::ceil(std::clamp(strength, 0.0, 1.0) * 4));
  for (int k = 0; k < n && int(m_drops.size()) < render::LensSoil::kMaxDrops; ++k) {
    const int at = int(seed & 0xffff) + 31 * k;
    const double angle = 6.2832 * varied(at, 1), far = 0.85 * std::sqrt(varied(at, 2));
    m_drops.push_back({float(far * std::cos(angle)), float(far * std::sin(angle)),
                       float(0.07 + 0.16 * varied(at, 3) * strength), drop_tint});
  }
  m_tint = {float(tint.r), float(tint.g), float(tint.b)};
}

/// Time since the frame before [s]. Who goes back in a recording looks through a lens of that time.
double Lens::since_last(std::uint64_t tick) {
  if (tick < m_tick) clear();
  const double passed = core::kTick * double(tick - std::min(tick, m_tick));
  m_tick = tick;
  return passed;
}

void Lens::list(const fluids::SmokeModel& model, const fluids::SmokeState& state, render::Frame& frame) {
  render::LensSoil& soil = frame.look.soil;
  const double passed = since_last(frame.tick);
  m_smear *= std::exp(-passed / kSmearTau);
  const bool wiping = state.wipe_left > 0, wiped = m_wipe_left > 0;
  if (wiping && !wiped) m_smear = 0;
  if (wiped && !wiping) {  // maybe seconds ago: pictures need not follow each other closely
    m_smear = kSmearLeft * std::exp(-std::max(passed - m_wipe_left, 0.0) / kSmearTau);
    m_drops.clear();
  }
  if (m_smear < 0.01) m_smear = 0;
  m_wipe_left = wiping ? state.wipe_left : 0;
  soil.fog = float(std::clamp(state.fog, 0.0, 1.0));
  soil.smear = float(m_smear);
  soil.smear_angle = kSwabAngle;
  const float pale = 0.7f;
  soil.smear_tint = {1 - pale + pale * m_tint.x, 1 - pale + pale * m_tint.y, 1 - pale + pale * m_tint.z};
  float stroke = -1;
  if (wiping && model.wipe_time > 0) {
    const float done = kStrokes * float(std::clamp(1 - state.wipe_left / model.wipe_time, 0.0, 1.0));
    stroke = std::min(std::floor(done), kStrokes - 1);
    soil.wipe = std::min(done - stroke, 1.0f);
    if (int(stroke) % 2 == 1) soil.smear_angle += float(portable::pi);
    if (stroke > 0) soil.fog = 0;  // the first stroke has taken it
    if (stroke > 0) soil.smear = float(kSmearLeft);
  }
  soil.drop_count = 0;
  for (const render::LensDrop& drop : m_drops) {
    // The swab takes them with it.
    const float side = drop.x * std::cos(kSwabAngle) + drop.y * std::sin(kSwabAngle);
    if (stroke > 0 || (stroke == 0 && side < -1.7f + 3.4f * soil.wipe)) continue;
    soil.drops[std::size_t(soil.drop_count++)] = drop;
  }
}

void Lens::clear() { *this = {}; }

}  // namespace trocar::view
