// What the window is made of, without a window: settings, gamepad lines, tones, notices.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/training/store/attempt.hpp>

#include "../other_process.hpp"
#include "shell/gamepads.hpp"
#include "shell/rumble.hpp"
#include "shell/settings.hpp"
#include "trainer/feedback.hpp"
#include "trainer/force_feel.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

class SettingsFile : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::temp_directory_path() / ("trocar_settings_" + std::to_string(getpid()));
    fs::create_directories(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }
  fs::path file() const { return m_folder / "settings.json"; }
  void write(const std::string& text) const { std::ofstream(file()) << text; }

  fs::path m_folder;
};

TEST_F(SettingsFile, WhatIsWrittenIsReadAgain) {
  Settings s;
  s.left_handed = s.both_hands = s.invert_x = s.mirrored_picture = true;
  s.mouse = 1.7;
  s.volume = 0.25;
  s.force_trace = s.force_sound = true;
  s.rumble = false;
  s.text_size = 1.4;
  s.window_width = 1920;
  s.trainee = "Zo\u00eb \u0416";
  s.show_hint = false;
  s.stereo = "anaglyph";
  s.eye_distance = 5.5;
  s.convergence = 60;
  s.swap_eyes = true;
  write_settings(file(), s);
  std::vector<core::Fault> faults;
  EXPECT_EQ(read_settings(file(), faults), s);
  EXPECT_TRUE(faults.empty());
}

TEST_F(SettingsFile, NoFileIsTheDefaultsAndNoFault) {
  std::vector<core::Fault> faults;
  EXPECT_EQ(read_settings(file(), faults), Settings{});
  EXPECT_TRUE(faults.empty());
}

TEST_F(SettingsFile, WhatIsWrongIsToldAndTheRestIsUsed) {
  write("{\"format\": 1,\n \"left_handed\": true,\n \"mouse\": 900,\n \"volum\": 1,\n \"text_size\": \"big\"}");
  std::vector<core::Fault> faults;
  const Settings s = read_settings(file(), faults);
  EXPECT_TRUE(s.left_handed);
  EXPECT_EQ(s.mouse, 1);
  EXPECT_EQ(s.text_size, 1);
  ASSERT_EQ(faults.size(), 3u);
  EXPECT_EQ(faults[0].at.line, 3);
}

TEST_F(SettingsFile, RubbishIsAFaultAndTheDefaults) {
  for (const char* text : {"", "nonsense", "[1, 2", "{\"format\": 1, \"mouse\": }", "\xff\xfe"}) {
    write(text);
    std::vector<core::Fault> faults;
    EXPECT_EQ(read_settings(file(), faults), Settings{}) << text;
    EXPECT_FALSE(faults.empty()) << text;
  }
}

TEST_F(SettingsFile, WhereItCannotBeWrittenTheOldOneStays) {
  write_settings(file(), {});
  chmod(m_folder.c_str(), 0555);
  const int status = test::elsewhere([this] {
    if (!test::become_nobody()) return 2;
    Settings other;
    other.mouse = 2;
    try {
      write_settings(file(), other);
    } catch (const core::EnvironmentLacks&) {
      return 0;
    }
    return 1;
  });
  EXPECT_EQ(status, 0) << "1: it was written; 2: root's rights cannot be given up";
  chmod(m_folder.c_str(), 0755);
  std::vector<core::Fault> faults;
  EXPECT_EQ(read_settings(file(), faults), Settings{});
}

TEST_F(SettingsFile, AFolderThatIsMadeForThemBelongsToItsUserAlone) {
  const mode_t before = umask(022);
  write_settings(file().parent_path() / "data" / "settings.json", {});
  umask(before);
  EXPECT_EQ(fs::status(file().parent_path() / "data").permissions(), fs::perms::owner_all);
}

TEST_F(SettingsFile, TheLastTraineeIsForgottenAndNobodyElse) {
  Settings settings;
  settings.trainee = "Ada";
  settings.mouse = 2;
  write_settings(file(), settings);
  EXPECT_FALSE(forget_in_settings(file(), "Bob"));
  std::vector<core::Fault> faults;
  EXPECT_EQ(read_settings(file(), faults), settings);
  EXPECT_TRUE(forget_in_settings(file(), "Ada"));
  settings.trainee.clear();
  EXPECT_EQ(read_settings(file(), faults), settings);
}

TEST_F(SettingsFile, NothingButTheSettingsIsLeftInTheFolder) {
  for (int i = 0; i < 3; ++i) write_settings(file(), {});
  EXPECT_EQ(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator{}), 1);
}

TEST(Settings, SensitivitiesScaleTheirDeviceOnly) {
  Settings s;
  s.mouse = 2;
  s.gamepad = 0.5;
  const devices::HandSettings usual = hand_settings({}, 3), mine = hand_settings(s, 3);
  EXPECT_FLOAT_EQ(mine.metres_per_pixel, 2 * usual.metres_per_pixel);
  EXPECT_FLOAT_EQ(mine.metres_per_notch, usual.metres_per_notch);
  EXPECT_FLOAT_EQ(mine.key_speed, usual.key_speed);
  EXPECT_FLOAT_EQ(mine.stick_speed, 0.5f * usual.stick_speed);
}

TEST(ProperName, HasNoControlCharactersNoBlanksAroundItAndWholeCharacters) {
  EXPECT_EQ(training::clean_name("  Ada\tLovelace\n "), "Ada Lovelace");
  EXPECT_EQ(training::clean_name("Zo\u00eb\xff\xc3"), "Zo\u00eb");
  std::string longest;
  for (int i = 0; i < 100; ++i) longest += "\u00e9";
  EXPECT_EQ(training::clean_name(longest).size(), training::kLongestName / 2 * 2);
  EXPECT_EQ(training::clean_name(" \n"), "");
}

TEST(GamepadLine, NumbersAndButtonsAreASample) {
  bool gone = true;
  const auto pad = read_gamepad_line("0.5 -1 0 0 0.25 1 y left_shoulder", gone);
  ASSERT_TRUE(pad.has_value());
  EXPECT_FALSE(gone);
  EXPECT_FLOAT_EQ(pad->left_x, 0.5f);
  EXPECT_FLOAT_EQ(pad->left_y, -1.0f);
  EXPECT_FLOAT_EQ(pad->left_trigger, 0.25f);
  EXPECT_TRUE(pad->has(devices::Button::y) && pad->has(devices::Button::left_shoulder));
  EXPECT_FALSE(pad->has(devices::Button::a));
}

TEST(GamepadLine, WhatIsNoSampleIsLeftOut) {
  bool gone = false;
  for (const char* line : {"", "0 0 0", "0 0 0 0 0 x", "0 0 0 0 0 0 hyperspace", "nan 0 0 0 0 0"})
    EXPECT_FALSE(read_gamepad_line(line, gone).has_value()) << line;
  EXPECT_FALSE(gone);
  EXPECT_FALSE(read_gamepad_line("gone", gone).has_value());
  EXPECT_TRUE(gone);
  EXPECT_FLOAT_EQ(read_gamepad_line("7 0 0 0 -3 9", gone)->left_x, 1.0f);
}

TEST(ForceFeel, ClicksComeFasterTheHarderItPressesAndNoneWhereNothingIsTouched) {
  const auto clicks = [](double force) {
    ForceFeel feel;
    int count = 0;
    for (int i = 0; i < 300; ++i) {
      feel.add(i / 60.0, {force, 0}, 5);
      count += feel.click();
    }
    return count;
  };
  EXPECT_EQ(clicks(0.01), 0);
  EXPECT_GE(clicks(0.2), 8);
  EXPECT_GT(clicks(2), clicks(0.2) + 10);
  EXPECT_GT(clicks(5), clicks(2) + 10);
  EXPECT_LE(clicks(500), 101);
}

TEST(ForceFeel, EachBeatIsToldOnceAndTurnsTheQuickMotor) {
  ForceFeel feel;
  int beats = 0;
  double weak = 0;
  for (int i = 0; i < 600; ++i) {
    const double t = i / 60.0, phase = t - std::floor(t);
    feel.add(t, {0.4, phase < 0.3 ? 0.08 * std::sin(phase / 0.3 * 3.14159) : 0}, 5);
    beats += feel.beat();
    weak = std::max(weak, feel.weak());
  }
  EXPECT_EQ(beats, 10);
  EXPECT_GT(weak, 0.8);
  EXPECT_NEAR(feel.trace().front().time, 600 / 60.0 - ForceFeel::kSeconds, 0.05);
  feel.forget();
  EXPECT_EQ(feel.strong(), 0);
  EXPECT_TRUE(feel.trace().empty());
}

TEST(Rumble, FindsThePadByTheIdentityInItsGuid) {
  const std::optional<PadIds> ids = ids_of_guid("030000005e0400008e02000010010000");
  ASSERT_TRUE(ids);
  EXPECT_EQ(*ids, (PadIds{3, 0x045e, 0x028e, 0x0110}));
  for (const char* bad : {"", "03", "030000005e0400008e0200001001000g", "05000000506f63746f720000000000aa",
                          "0300000000000000000000000000000000"})
    EXPECT_FALSE(ids_of_guid(bad)) << bad;
}

TEST(Rumble, WithoutAPadNothingTurnsAndLevelsStayInTheirBounds) {
  Rumble rumble;
  rumble.use("030000005e0400008e02000010010000");
  rumble.set(1, 1, 0);
  EXPECT_FALSE(rumble.turns());
  EXPECT_EQ(motor_level(0), 0);
  EXPECT_EQ(motor_level(7), 65535);
  EXPECT_EQ(motor_level(std::nan("")), 0);
}

TEST(Tones, BeginAndEndInSilenceAndAreHeard) {
  for (int t = 0; t < int(Tone::count); ++t) {
    const std::vector<std::int16_t> sound = samples_of(Tone(t), 44100);
    ASSERT_GT(sound.size(), Tone(t) == Tone::touch ? 44100u / 100 : 44100u / 25) << t;  // clicks follow each other
    ASSERT_LT(sound.size(), 44100u) << t;
    EXPECT_LT(std::abs(sound.front()), 200) << t;
    EXPECT_LT(std::abs(sound.back()), 200) << t;
    double power = 0;
    for (const std::int16_t v : sound) power += double(v) * v;
    EXPECT_GT(std::sqrt(power / double(sound.size())), 300) << t;
    EXPECT_EQ(sound, samples_of(Tone(t), 44100)) << t;
  }
}

TEST(Feedback, StepsAndErrorsAreShownNearThePictureAndStayInTheList) {
  Feedback feedback;
  const Notice* done = feedback.add({100, "step-done", -1, "First clip"}, 12, 50);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->mark, ui::Mark::done);
  EXPECT_EQ(done->tone, Tone::step_done);
  EXPECT_EQ(feedback.add({101, "error", -1, "E3: slipped"}, 13, 51)->tone, Tone::error);
  EXPECT_FALSE(feedback.add({102, "something-else", -1, ""}, 14, 52));
  EXPECT_EQ(feedback.fresh(51).size(), 2u);
  EXPECT_EQ(feedback.fresh(56).size(), 1u);  // errors stay longer
  EXPECT_TRUE(feedback.fresh(100).empty());
  EXPECT_EQ(feedback.all().size(), 2u);
}

TEST(Feedback, TheListIsBounded) {
  Feedback feedback;
  for (int i = 0; i < 1000; ++i) feedback.add({std::uint64_t(i), "grasped", 0, std::to_string(i)}, i, i);
  EXPECT_EQ(feedback.all().size(), Feedback::kMost);
  EXPECT_EQ(feedback.all().back().text, "999");
}

TEST(PullWarning, BeginsNearTheLimitAndRepeatsWhileItLasts) {
  PullWarning warning;
  EXPECT_FALSE(warning.due(3.0, 4, 0));
  EXPECT_TRUE(warning.due(3.3, 4, 1));
  EXPECT_FALSE(warning.due(3.3, 4, 1.1));
  EXPECT_TRUE(warning.due(3.0, 4, 2));  // a little less is still near
  EXPECT_FALSE(warning.due(2.5, 4, 3));
}

}  // namespace
}  // namespace trocar::app
