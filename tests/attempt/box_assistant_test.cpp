// The assistant that finds out how a box is wired, asked by somebody who sits at one that is wired oddly.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/attempt/box/assistant.hpp>
#include <trocar/attempt/box/box_file.hpp>
#include <trocar/core/random.hpp>

namespace trocar::attempt {
namespace {

using devices::BoxActor;
using devices::BoxAxis;
using devices::BoxBlock;

/// Channels from the top down, bent and falling tables, switches that are closed at 0.
devices::BoxWiring odd_box() {
  devices::BoxWiring box = devices::default_wiring();
  for (auto& actor : box.axes)
    for (devices::WiredAxis& axis : actor) {
      axis.channel = 47 - axis.channel;
      std::reverse(axis.table.values.begin(), axis.table.values.end());
      const double middle = (axis.table.values[0] + axis.table.values[1]) / 2;
      axis.table = {{300, 2200, 3800}, {axis.table.values[0], middle, axis.table.values[1]}};
    }
  for (int& pedal : box.pedals) pedal = 31 - pedal;
  box.inverted = 1u << 31 | 1u << 9;
  return box;
}

/// Somebody at the box who does what they are told; hands tremble and channels are noisy.
class Sitter {
 public:
  explicit Sitter(const devices::BoxWiring& box) : m_box(box) {}

  void obey(BoxAssistant& assistant) {
    const BoxQuestion q = assistant.question();
    const devices::WiredAxis& axis = m_box.axis(q.actor, q.axis);
    if (q.kind == BoxQuestion::Kind::sweep) {
      for (int i = 0; i <= 60; ++i) {
        const double share = 0.5 + 0.45 * std::sin(i * 0.2);
        show(assistant, axis.channel, 300 + share * 3500);
      }
    } else if (q.kind == BoxQuestion::Kind::hold) {
      for (int i = 0; i < 40; ++i) show(assistant, axis.channel, axis.table.code(q.value));
    } else {
      const int bit = q.pedal >= 0 ? m_box.pedals[std::size_t(q.pedal)]
                                   : m_box.buttons[std::size_t(q.actor)][std::size_t(q.button)];
      for (const bool down : {false, true, true, false}) press(assistant, down ? bit : -1);
    }
  }
  void show(BoxAssistant& assistant, int channel, double code) {
    BoxBlock block = rest();
    block.codes[std::size_t(channel)] = std::uint16_t(std::clamp(code + noise(), 0.0, 4095.0));
    see(assistant, block);
  }
  void press(BoxAssistant& assistant, int bit) {
    BoxBlock block = rest();
    if (bit >= 0) block.digital ^= 1u << bit;
    see(assistant, block);
  }
  BoxBlock rest() {
    BoxBlock block;
    for (std::uint16_t& code : block.codes) code = std::uint16_t(2000 + noise());
    block.digital = m_box.inverted;
    return block;
  }
  void see(BoxAssistant& assistant, const BoxBlock& block) { assistant.see(block, m_now += 20'000'000); }

 private:
  double noise() { return std::round(4 * m_random.uniform() - 2); }
  devices::BoxWiring m_box;
  core::Random m_random{7};
  devices::BoxTime m_now = 0;
};

BoxParts everything() {
  BoxParts parts;
  parts.actors.fill(true);
  return parts;
}

TEST(BoxAssistant, FindsEveryChannelAndSwitchOfABoxThatIsWiredOddlyAndItsTablesWithinAQuarterOfADegree) {
  const devices::BoxWiring box = odd_box();
  BoxAssistant assistant(devices::default_wiring(), everything());
  Sitter sitter(box);
  while (!assistant.done()) {
    sitter.obey(assistant);
    ASSERT_EQ(assistant.take(), "") << assistant.question().text;
  }
  const devices::BoxWiring& found = assistant.wiring();
  EXPECT_EQ(found.pedals, box.pedals);
  EXPECT_EQ(found.buttons, box.buttons);
  EXPECT_EQ(found.inverted, box.inverted);
  for (int actor = 0; actor < devices::kBoxActors; ++actor)
    for (int which = 0; which < devices::kBoxAxes; ++which) {
      const devices::WiredAxis& a = found.axis(BoxActor(actor), BoxAxis(which));
      const devices::WiredAxis& b = box.axis(BoxActor(actor), BoxAxis(which));
      EXPECT_EQ(a.channel, b.channel);
      EXPECT_EQ(devices::unfit(a.table), "");
      const double span = std::abs(b.table.values.back() - b.table.values.front());
      for (const double code : a.table.codes) EXPECT_NEAR(a.table.value(code), b.table.value(code), span / 480);
    }
}

TEST(BoxAssistant, ItsFileIsReadAsWhatItFound) {
  BoxAssistant assistant(devices::default_wiring(), BoxParts{});
  Sitter sitter(odd_box());
  while (!assistant.done()) sitter.obey(assistant), assistant.take();
  const scene::MemoryFiles files{{"box.json", box_file_text(assistant.wiring())}};
  std::vector<core::Fault> faults;
  const devices::BoxWiring read = read_box_file("box.json", faults, &files);
  ASSERT_TRUE(faults.empty()) << core::to_string(faults[0]);
  EXPECT_EQ(read.mask(), assistant.wiring().mask());
  EXPECT_EQ(read.pedals, assistant.wiring().pedals);
  EXPECT_FALSE(read.has(BoxActor::third));
}

TEST(BoxAssistant, TakesNoAxisOfTwoThatMovedTogetherUntilOneIsChosen) {
  BoxAssistant assistant(devices::default_wiring(), BoxParts{});
  Sitter sitter(odd_box());
  for (int i = 0; i < 30; ++i) {
    BoxBlock block = sitter.rest();
    block.codes[3] = block.codes[7] = std::uint16_t(1000 + 60 * i);
    sitter.see(assistant, block);
  }
  EXPECT_NE(assistant.take().find("both moved"), std::string::npos);
  EXPECT_EQ(assistant.number(), 0u);
  EXPECT_EQ(assistant.choose(7), "");
  EXPECT_EQ(assistant.wiring().axis(BoxActor::left, BoxAxis::yaw).channel, 7);
}

TEST(BoxAssistant, TakesNoRowFromAHandThatMovesOrHasNotMovedSinceTheLast) {
  BoxAssistant assistant(devices::default_wiring(), BoxParts{});
  Sitter sitter(odd_box());
  ASSERT_EQ(assistant.choose(5), "");
  for (int i = 0; i < 40; ++i) sitter.show(assistant, 5, 1000 + 4 * i);
  EXPECT_NE(assistant.take().find("the axis is moving"), std::string::npos);
  for (int i = 0; i < 40; ++i) sitter.show(assistant, 5, 1000);
  EXPECT_EQ(assistant.take(), "");
  for (int i = 0; i < 40; ++i) sitter.show(assistant, 5, 1000);
  EXPECT_NE(assistant.take().find("the previous position"), std::string::npos);
  for (int i = 0; i < 40; ++i) sitter.show(assistant, 5, 2000);
  EXPECT_EQ(assistant.take(), "");
  for (int i = 0; i < 40; ++i) sitter.show(assistant, 5, 1500);
  EXPECT_NE(assistant.take().find("contradicts"), std::string::npos) << "the angles rise, the codes do not";
}

TEST(BoxAssistant, OneBlockThatComesWrongMovesNothing) {
  BoxAssistant assistant(devices::default_wiring(), BoxParts{});
  Sitter sitter(odd_box());
  for (int i = 0; i < 40; ++i) sitter.show(assistant, 11, i == 20 ? 4000 : 2000);
  EXPECT_EQ(assistant.found(), -1);
  EXPECT_LT(assistant.moved(), 10);
}

TEST(BoxAssistant, TakesASwitchOnlyWhenItWasPressedAloneAndLetGo) {
  BoxParts parts;
  parts.actors.fill(false);
  BoxAssistant assistant(devices::default_wiring(), parts);
  Sitter sitter(odd_box());
  sitter.press(assistant, -1);
  EXPECT_EQ(assistant.why_not(), "nothing was pressed");
  sitter.press(assistant, 4);
  EXPECT_EQ(assistant.why_not(), "let it go");
  sitter.press(assistant, -1);
  EXPECT_EQ(assistant.take(), "");
  for (const int bit : {-1, 4, -1}) sitter.press(assistant, bit);
  EXPECT_EQ(assistant.take(), "this contact is already assigned");
  for (const int bit : {6, -1, 9, -1}) sitter.press(assistant, bit);
  EXPECT_EQ(assistant.take(), "several contacts closed: press only this one");
}

TEST(BoxAssistant, GoesBackToWhatWasSkippedOrTaken) {
  BoxAssistant assistant(devices::default_wiring(), BoxParts{});
  Sitter sitter(odd_box());
  sitter.obey(assistant);
  ASSERT_EQ(assistant.take(), "");
  const std::size_t held = assistant.number();
  assistant.add_row(0.3);
  assistant.skip();
  EXPECT_EQ(assistant.wiring().axis(BoxActor::left, BoxAxis::yaw).channel, -1);
  EXPECT_EQ(assistant.question().axis, BoxAxis::pitch);
  assistant.back();
  EXPECT_EQ(assistant.number(), held);
  EXPECT_EQ(assistant.wiring().axis(BoxActor::left, BoxAxis::yaw).channel, 47);
  assistant.back();
  EXPECT_EQ(assistant.wiring().mask(), 0u);
  EXPECT_FALSE(assistant.can_go_back());
}

}  // namespace
}  // namespace trocar::attempt
