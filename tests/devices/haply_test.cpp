#include <chrono>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>
#include <trocar/devices/haptics/choose_device.hpp>
#include <trocar/devices/haptics/haply_device.hpp>
#include <trocar/devices/haptics/haply_messages.hpp>

#include "fake_haply.hpp"

using namespace trocar;
using namespace trocar::devices;

namespace {

const char* const kInventory =
    R"({"session_id":7,"inverse3":[{"device_id":"049D","config":{"type":"inverse3"},
    "state":{"cursor_position":{"x":0.01,"y":-0.12,"z":0.15}},"status":{"ready":true}}],
    "wireless_verse_grip":[{"device_id":"61548","state":{"buttons":{"a":true,"b":false,"c":true},
    "orientation":{"w":0.7071068,"x":0,"y":0.7071068,"z":0}}}]})";

std::string position_message(double z) {
  return R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0,"y":0,"z":)" + std::to_string(z) +
         "}}}]}";
}

template <class Done>
bool wait_until(Done done) {
  for (int i = 0; i < 3000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace

TEST(WebSocket, AnswersTheKeyOfTheStandardAsTheStandardDoes) {
  EXPECT_EQ(web_socket_answer("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");  // [RFC 6455 section 1.3]
}

TEST(WebSocket, FramesArriveWholeHoweverTheyAreCutAndInterruptedByPings) {
  const std::string bytes =
      std::string("\x01\x03Hel\x89\x02hi\x80\x02lo", 13) + FakeHaply::frame(std::string(300, 'x'));
  for (std::size_t piece = 1; piece < 9; ++piece) {
    FrameReader reader;
    std::string text, all;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      reader.add(std::string_view(bytes).substr(at, piece));
      for (FrameReader::Got got = reader.next(text); got != FrameReader::Got::nothing; got = reader.next(text))
        all += (got == FrameReader::Got::ping      ? "ping "
                : got == FrameReader::Got::message ? "message "
                                                   : "? ") +
               text + ";";
    }
    EXPECT_EQ(all, "ping hi;message Hello;message " + std::string(300, 'x') + ";") << piece;
  }
}

TEST(WebSocket, WhatBreaksTheProtocolIsAFaultAndNothingGrowsBeyondItsBound) {
  const auto verdict = [](const std::string& bytes) {
    FrameReader reader;
    reader.add(bytes);
    std::string text;
    return reader.next(text);
  };
  EXPECT_EQ(verdict(std::string("\x81\x83kkkkabc", 9)), FrameReader::Got::fault);   // masked by a server
  EXPECT_EQ(verdict(std::string("\xc1\x01x", 3)), FrameReader::Got::fault);         // an extension
  EXPECT_EQ(verdict(std::string("\x80\x01x", 3)), FrameReader::Got::fault);         // goes on with nothing
  EXPECT_EQ(verdict(std::string("\x89\x7e\x01\x00", 4)), FrameReader::Got::fault);  // a long ping
  EXPECT_EQ(verdict(std::string("\x81\x7f\x7f\xff\xff\xff\xff\xff\xff\xff", 10)), FrameReader::Got::fault);
  FrameReader endless;
  std::string text;
  FrameReader::Got got = FrameReader::Got::nothing;
  for (int i = 0; i < 20 && got == FrameReader::Got::nothing; ++i) {
    endless.add(std::string(i == 0 ? "\x01\x7e\x20\x00" : std::string("\x00\x7e\x20\x00", 4)).append(8192, 'x'));
    got = endless.next(text);
  }
  EXPECT_EQ(got, FrameReader::Got::fault);
}

TEST(WebSocket, RandomBytesNeverDoMoreThanEndIt) {
  core::Random random(11);
  for (int trial = 0; trial < 3000; ++trial) {
    FrameReader reader;
    std::string text;
    for (int i = 0; i < 40; ++i) {
      const char byte = char(random.next() >> 32);
      reader.add({&byte, 1});
      const FrameReader::Got got = reader.next(text);
      ASSERT_LE(text.size(), FrameReader::kMostBytes);
      if (got == FrameReader::Got::fault) break;
    }
  }
}

TEST(Haply, ReadsPositionTurnAndButtonsOfTheServicesMessages) {
  const std::optional<HaplyState> s = read_haply(kInventory);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->device, "049D");
  EXPECT_EQ(s->sample.position, (Vec3d{0.01, -0.12, 0.15}));
  EXPECT_EQ(s->sample.switches, 5u);
  EXPECT_TRUE(s->turns);
  EXPECT_NEAR(s->sample.rotation.y, 0.70710678, 1e-7);
}

TEST(Haply, LeavesOutWhatIsNoMessageOfADevice) {
  for (const char* text :
       {"", "{", "null", "[]", R"({"inverse3":[]})", R"({"inverse3":{}})", R"({"inverse3":[{"device_id":4}]})",
        R"({"inverse3":[{"device_id":"a\"}]","state":{"cursor_position":{"x":0,"y":0,"z":0}}}]})",
        R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":0,"y":0}}}]})",
        R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":0,"y":0,"z":1e9}}}]})",
        R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":0,"y":"0","z":0}}}]})"})
    EXPECT_FALSE(read_haply(text)) << text;
  EXPECT_FALSE(read_haply(std::string(60000, '[')));
}

TEST(Haply, MutatedMessagesAreReadOrLeftOutAndNothingElse) {
  core::Random random(17);
  const std::string good = kInventory;
  int read = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::string text = good;
    for (std::uint64_t k = random.next() % 6; k-- > 0;) text[random.next() % text.size()] = char(random.next() >> 20);
    if (const std::optional<HaplyState> s = read_haply(text)) {
      ASSERT_TRUE(plausible(s->sample));
      ++read;
    }
  }
  EXPECT_GT(read, 300);
}

TEST(Haply, DeviceTalksWithAServiceMessageForMessageAndTheForceIsInThem) {
  std::mutex lock;
  std::vector<std::string> heard;
  double z = 0.15;
  FakeHaply service([&](const std::string& said) {
    const std::lock_guard hold(lock);
    if (said.empty()) return std::string(kInventory);
    heard.push_back(said);
    return position_message(z += 0.001);
  });
  HaplyDevice device(service.port());
  device.open();
  EXPECT_EQ(device.capabilities().name, "Haply Inverse3");
  HapticSample sample;
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(wait_until([&] { return device.read(sample); })) << i;
    EXPECT_NEAR(sample.position.z, 0.151 + 0.001 * i, 1e-6);
    device.write({{0.5, -1.25, 2}, {}, 0});
  }
  device.close();
  const std::lock_guard hold(lock);
  EXPECT_NE(heard.front().find("\"profile\":{\"name\":\"trocar:train\"}"), std::string::npos);
  EXPECT_EQ(heard[1].find("session"), std::string::npos);
  EXPECT_EQ(
      heard[1],
      R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"values":{"x":0.50000,"y":-1.25000,"z":2.00000}}}}]})");
}

TEST(Haply, WithoutServiceOrDeviceItSaysWhatToDo) {
  const auto fault = [](HaplyDevice& device) -> std::string {
    try {
      device.open();
    } catch (const core::EnvironmentLacks& lacks) {
      return lacks.what();
    }
    return {};
  };
  int free_port = 0;
  {
    FakeHaply service([](const std::string&) { return std::string(R"({"inverse3":[]})"); });
    free_port = service.port();
    HaplyDevice device(free_port, 0.2);
    EXPECT_NE(fault(device).find("plug it in"), std::string::npos);
  }
  HaplyDevice nobody(free_port, 0.2);
  EXPECT_NE(fault(nobody).find("start it"), std::string::npos);
}

TEST(HapticDevices, AreChosenByNameAndAWrongNameIsRefused) {
  EXPECT_TRUE(choose_haptic_device("simulated", "--haptics")->is_led());
  EXPECT_EQ(choose_haptic_device("haply:12345", "--haptics")->capabilities().name, "Haply Inverse3");
  EXPECT_EQ(choose_haptic_device("seam:12345", "--haptics")->capabilities().name, "seam");
  for (const char* bad :
       {"", "seam", "seam:", "seam:0", "seam:70000", "seam:99999999999999999999", "haply:-1", "falcon"})
    EXPECT_THROW(choose_haptic_device(bad, "--haptics"), core::BadInput) << bad;
}
