#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>
#include <trocar/devices/haptics/haptic_loop.hpp>
#include <trocar/devices/haptics/seam_device.hpp>
#include <trocar/devices/haptics/seam_protocol.hpp>

using namespace trocar;
using namespace trocar::devices;

namespace {

/// The other side of the seam.
class Link {
 public:
  explicit Link(int port) : m_socket(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(std::uint16_t(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(m_socket, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
  }
  ~Link() { close(m_socket); }
  void say(std::span<const std::uint8_t> bytes) {
    EXPECT_EQ(send(m_socket, bytes.data(), bytes.size(), 0), ssize_t(bytes.size()));
  }
  void say(const HapticSample& sample) {
    std::array<std::uint8_t, kSampleBytes> bytes;
    write_sample(bytes, sample);
    say(bytes);
  }
  std::optional<HapticForce> hear(std::uint32_t& number) {
    std::array<std::uint8_t, 256> bytes;
    const ssize_t n = recv(m_socket, bytes.data(), bytes.size(), 0);
    return n < 0 ? std::nullopt : read_force(std::span(bytes).first(std::size_t(n)), number);
  }

 private:
  int m_socket;
};

HapticSample at(double z, std::uint32_t number) {
  HapticSample s;
  s.position.z = z;
  s.number = number;
  return s;
}

}  // namespace

TEST(Seam, WhatIsWrittenIsReadBack) {
  HapticSample s = at(0.02, 77);
  s.rotation = normalised(Quatd{1, 0.2, -0.3, 0.4});
  s.grip = 0.25;
  s.switches = 5;
  std::array<std::uint8_t, kSampleBytes> bytes;
  write_sample(bytes, s);
  const std::optional<HapticSample> back = read_sample(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->position, s.position);
  EXPECT_EQ(back->rotation, s.rotation);
  EXPECT_EQ(back->grip, 0.25);
  EXPECT_EQ(back->switches, 5u);
  EXPECT_EQ(back->number, 77u);
}

TEST(Seam, RefusesOtherLengthsMarksAndValuesThatNoDeviceHas) {
  std::array<std::uint8_t, kSampleBytes> good, bad;
  write_sample(good, at(0.02, 1));
  EXPECT_FALSE(read_sample(std::span(good).first(kSampleBytes - 1)));
  EXPECT_FALSE(read_sample({}));
  bad = good;
  bad[3] = '2';
  EXPECT_FALSE(read_sample(bad));
  HapticSample far = at(1e6, 1), odd = at(0, 1), shut = at(0, 1);
  odd.rotation = {0, 0, 0, 0};
  shut.grip = std::nan("");
  for (const HapticSample& s : {far, odd, shut}) {
    write_sample(bad, s);
    EXPECT_FALSE(read_sample(bad));
  }
  core::Random random(23);
  for (int trial = 0; trial < 5000; ++trial) {
    bad = good;
    for (int k = 0; k < 4; ++k) bad[4 + random.next() % (kSampleBytes - 4)] = std::uint8_t(random.next() >> 40);
    if (const std::optional<HapticSample> s = read_sample(bad)) {
      ASSERT_TRUE(plausible(*s));
    }
  }
}

TEST(Seam, TakesTheNewestSampleOfTheFirstThatSpeaksAndAnswersItWithForces) {
  SeamDevice device(0, 1);
  device.bind();
  Link own(device.port()), other(device.port());
  HapticCapabilities can;
  can.force_max = 7;
  can.own_damping = 3;
  can.reach = {0.1, 0.2, 0.3};
  std::array<std::uint8_t, kAbilityBytes> abilities;
  write_abilities(abilities, can);
  own.say(abilities);
  own.say(at(0.001, 1));
  device.open();
  EXPECT_EQ(device.capabilities().force_max, 7);
  EXPECT_EQ(device.capabilities().reach.z, 0.3);
  other.say(at(0.5, 99));
  const std::uint8_t nonsense[] = {1, 2, 3};
  own.say(nonsense);
  own.say(at(0.002, 2));
  own.say(at(0.003, 3));
  HapticSample sample;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_TRUE(device.read(sample));
  EXPECT_EQ(sample.position.z, 0.003);
  device.write({{0, 0, 1.5}, {}, 0});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::uint32_t number = 0;
  const std::optional<HapticForce> force = own.hear(number);
  ASSERT_TRUE(force);
  EXPECT_EQ(force->force.z, 1.5);
  EXPECT_EQ(number, 3u);
  EXPECT_FALSE(other.hear(number));
}

TEST(Seam, WithoutAProgramItSaysWhatToDo) {
  SeamDevice device(0, 0.05);
  try {
    device.open();
    FAIL() << "nobody has spoken";
  } catch (const core::EnvironmentLacks& lacks) {
    EXPECT_NE(std::string(lacks.what()).find("start the program"), std::string::npos) << lacks.what();
  }
}

namespace {

/// A device that presses 10 mm deep into a floor, 1000 times a second, and hears what it is pushed with.
struct Presser {
  explicit Presser(SeamDevice& device) : link(device.port()) {}
  void state(double force_max) {
    HapticCapabilities can;
    can.force_max = force_max;
    can.own_damping = 3;
    std::array<std::uint8_t, kAbilityBytes> bytes;
    write_abilities(bytes, can);
    link.say(bytes);
  }
  /// @return the greatest force that was heard meanwhile
  double press(HapticLoop* loop, double seconds) {
    LocalModel floor;
    floor.plane[0] = {{0, 0, 0}, {0, 0, 1}};
    floor.planes = 1;
    floor.stiffness = 400;
    double most = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (; std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
      link.say(at(-0.01, ++number));
      if (loop) loop->put(floor);
      std::uint32_t answered = 0;
      while (const std::optional<HapticForce> force = link.hear(answered)) most = std::max(most, length(force->force));
    }
    return most;
  }
  Link link;
  std::uint32_t number = 0;
};

/// An open device whose program has sent samples and no abilities.
std::unique_ptr<SeamDevice> opened(std::unique_ptr<Presser>& presser) {
  auto device = std::make_unique<SeamDevice>(0, 1);
  device->bind();
  presser = std::make_unique<Presser>(*device);
  presser->press(nullptr, 0.02);
  device->open();
  return device;
}

}  // namespace

TEST(Seam, AWeakDeviceThatSaysSoAfterItsFirstSamplesIsHeard) {
  std::unique_ptr<Presser> presser;
  HapticLoop loop(opened(presser));
  EXPECT_EQ(presser->press(&loop, 0.1), 0) << "what it bears is not known yet";
  presser->state(0.1);
  const double most = presser->press(&loop, 0.5);
  EXPECT_LE(most, 0.1 + 1e-9);
  EXPECT_GT(most, 0.05);
}

TEST(Seam, ADeviceThatNeverSaysWhatItCanIsTakenForAModestOneAfterHalfASecond) {
  std::unique_ptr<Presser> presser;
  HapticLoop loop(opened(presser));
  EXPECT_EQ(presser->press(&loop, 0.2), 0);
  const double most = presser->press(&loop, 0.9);
  EXPECT_GT(most, 1);
  EXPECT_LE(most, 3 + 1e-9);
  presser->state(0.1);
  presser->press(&loop, 0.05);
  EXPECT_LE(presser->press(&loop, 0.2), 0.1 + 1e-9) << "less counts at once";
}

TEST(Seam, TheExampleProgramIsADeviceThatAWallHoldsBack) {
  auto device = std::make_unique<SeamDevice>(0, 5);
  device->bind();
  const std::string command =
      "python3 " TROCAR_SOURCE_DIR "/tests/devices/fake_haptic_device.py " + std::to_string(device->port()) + " 1.5";
  std::FILE* program = popen(command.c_str(), "r");
  ASSERT_NE(program, nullptr);
  device->open();
  LocalModel floor;
  floor.plane[0] = {{0, 0, -0.002}, {0, 0, 1}};
  floor.planes = 1;
  floor.stiffness = 400;
  {
    HapticLoop loop(std::move(device));
    HandReport report;
    double most = 0;
    for (int i = 0; i < 1200; ++i) {
      loop.put(floor);
      if (loop.take(report)) most = std::max(most, report.force.z);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_GT(most, 0.5);
  }
  char line[200] = "";
  EXPECT_NE(std::fgets(line, sizeof line, program), nullptr);
  EXPECT_EQ(pclose(program), 0);
  double force = 0;
  int samples = 0;
  EXPECT_EQ(std::sscanf(line, "%d samples, most force %lf", &samples, &force), 2) << line;
  EXPECT_GT(force, 0.5) << line;
}
