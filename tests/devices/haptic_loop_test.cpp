#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include <trocar/devices/haptics/haptic_loop.hpp>
#include <trocar/devices/haptics/simulated_device.hpp>

using namespace trocar;
using namespace trocar::devices;

namespace {

/// Notes what a loop does to it; speaks as long as it is told to.
class Dummy : public HapticDevice {
 public:
  struct Log {
    std::atomic<double> force{0};
    std::atomic<bool> closed{false}, speaks{true};
  };
  explicit Dummy(Log& log) : m_log(log) {
    m_capabilities.own_damping = 5;
    m_capabilities.force_max = 3;
  }
  void open() override {}
  void close() noexcept override { m_log.closed = true; }
  const HapticCapabilities& capabilities() const noexcept override { return m_capabilities; }
  bool read(HapticSample& sample) noexcept override {
    sample.position = {0, 0, -0.01};
    return m_log.speaks;
  }
  void write(const HapticForce& force) noexcept override { m_log.force = length(force.force); }

 private:
  Log& m_log;
  HapticCapabilities m_capabilities;
};

LocalModel deep_floor() {
  LocalModel m;
  m.plane[0] = {{0, 0, 0}, {0, 0, 1}};
  m.planes = 1;
  m.stiffness = 200;
  return m;
}

template <class Done>
bool wait_for(Done done) {
  for (int i = 0; i < 5000 && !done(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return done();
}

}  // namespace

TEST(HapticLoop, PushesWhileTheSimulationSpeaksAndNotWhenItHasFallenSilent) {
  Dummy::Log log;
  HapticLoop loop(std::make_unique<Dummy>(log));
  HandReport report;
  EXPECT_TRUE(wait_for([&] {
    loop.put(deep_floor());
    return log.force > 1.9;
  }));
  EXPECT_TRUE(wait_for([&] { return log.force == 0; }));
  EXPECT_TRUE(loop.take(report));
  EXPECT_EQ(report.sample.position.z, -0.01);
  loop.stop();
  EXPECT_TRUE(log.closed);
  EXPECT_EQ(log.force, 0);
}

TEST(HapticLoop, LetsGoWhenTheDeviceFallsSilent) {
  Dummy::Log log;
  HapticLoop loop(std::make_unique<Dummy>(log));
  const auto push = [&] {
    loop.put(deep_floor());
    return log.force > 1.9;
  };
  EXPECT_TRUE(wait_for(push));
  log.speaks = false;
  HandReport report;
  EXPECT_TRUE(wait_for([&] {
    push();
    loop.take(report);
    return log.force == 0 && report.lost;
  }));
}

TEST(HapticLoop, CountsItsPeriodsAndWhatTheyTook) {
  HapticLoop loop(std::make_unique<SimulatedDevice>());
  EXPECT_TRUE(wait_for([&] { return loop.periods().count() > 50; }));
  loop.stop();
  EXPECT_GE(loop.computing().count(), loop.periods().count());
  EXPECT_GT(loop.periods().quantile(0.5), 0.0005);
  EXPECT_LE(loop.periods().quantile(0.5), loop.periods().quantile(0.999));
}

TEST(Durations, QuantilesAreThoseOfWhatWasAddedToTheMicrosecondAbove) {
  Durations d;
  for (int i = 1; i <= 1000; ++i) d.add(1e-6 * i - 0.5e-6);
  EXPECT_NEAR(d.quantile(0.5), 500e-6, 1e-9);
  EXPECT_NEAR(d.quantile(0.99), 990e-6, 1e-9);
  EXPECT_NEAR(d.quantile(0.999), 999e-6, 1e-9);
  d.add(5);
  EXPECT_EQ(d.longest(), 5);
  EXPECT_NEAR(d.quantile(1), 0.01, 1e-9);
}
