#include <algorithm>
#include <cmath>

#include <time.h>

#include <trocar/devices/haptics/haptic_loop.hpp>
#include <trocar/devices/real_time.hpp>

namespace trocar::devices {
namespace {

constexpr double kGone = 1e9;   // [s] of a side that was never heard
constexpr double kLost = 0.25;  // [s]

double clock_seconds() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

void sleep_until(double seconds) {
  const double whole = std::floor(seconds);
  const timespec t{time_t(whole), long(1e9 * (seconds - whole))};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
  }
}

double since(double at, double now) { return at < 0 ? kGone : now - at; }

}  // namespace

HapticLoop::HapticLoop(std::unique_ptr<HapticDevice> device, const ForceRenderer::Settings& settings)
    : m_device(std::move(device)), m_renderer(m_device->capabilities(), settings) {
  m_report.turns = m_device->capabilities().turns;
  m_report.grips = m_device->capabilities().grips;
  m_thread = std::thread([this] { run(); });
}

void HapticLoop::stop() noexcept {
  m_stop.store(true);
  if (m_thread.joinable()) m_thread.join();
}

void HapticLoop::run() noexcept {
  m_real_time.store(raise_priority());
  const double period = m_renderer.settings().period;
  double due = clock_seconds(), last = -1;
  while (!m_stop.load(std::memory_order_relaxed)) {
    const double now = clock_seconds();
    if (last >= 0) m_periods.add(now - last);
    last = now;
    once(now);
    const double done = clock_seconds();
    m_computing.add(done - now);
    due += period;
    if (done > due + period) {
      const double late = std::floor((done - due) / period);
      m_missed.store(m_missed.load(std::memory_order_relaxed) + std::uint64_t(late), std::memory_order_relaxed);
      due += late * period;
    }
    sleep_until(due);
  }
  m_device->write({});
  m_device->close();
}

void HapticLoop::once(double now) noexcept {
  if (m_models.take(m_model)) m_model_at = now;
  HapticSample sample = m_report.sample;
  if (m_device->read(sample) && plausible(sample)) {
    m_report.sample = sample;
    m_sample_at = now;
  }
  if (const HapticCapabilities* can = m_device->new_capabilities()) {
    m_renderer.adapt(*can);
    m_report.turns = can->turns;
    m_report.grips = can->grips;
  }
  const double silence = m_device->may_push() ? std::max(since(m_model_at, now), since(m_sample_at, now)) : kGone;
  const HapticForce force = m_renderer.force(m_report.sample, m_model, silence);
  m_device->write(force);
  m_report.force = force.force;
  m_report.share = m_renderer.share();
  m_report.damping = m_renderer.passivity().damping();
  m_report.lost = since(m_sample_at, now) > kLost;
  if (m_sample_at >= 0) m_reports.put(m_report);
}

}  // namespace trocar::devices
