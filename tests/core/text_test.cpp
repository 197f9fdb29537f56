#include <cstring>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

namespace trocar {
namespace {

const char* german(const char* text) {
  if (std::strcmp(text, "Paused") == 0) return "Angehalten";
  if (std::strcmp(text, "{} of {} points") == 0) return "{1} Punkte, davon erreicht: {0}";
  if (std::strcmp(text, "{} s left") == 0) return "noch {} von {} s";  // asks for a value that is not there
  return text;
}

struct Text : testing::Test {
  ~Text() override { set_translator(nullptr); }
};

TEST_F(Text, IsReturnedAsWrittenWithoutATranslator) {
  EXPECT_STREQ(tr("Paused"), "Paused");
  EXPECT_EQ(tr("{} of {} points", 3, 4.5), "3 of 4.5 points");
}

TEST_F(Text, IsTranslated) {
  set_translator(german);
  EXPECT_STREQ(tr("Paused"), "Angehalten");
  EXPECT_EQ(tr("{} of {} points", 3, 4.5), "4.5 Punkte, davon erreicht: 3");
}

TEST_F(Text, WithoutATranslationIsReturnedAsWritten) {
  set_translator(german);
  EXPECT_STREQ(tr("Resume"), "Resume");
  EXPECT_EQ(tr("{:.1f} mm", 2.04), "2.0 mm");
}

TEST_F(Text, WithAFaultyTranslationIsShownInTheOriginal) {
  set_translator(german);
  EXPECT_EQ(tr("{} s left", 5), "5 s left");
}

TEST_F(Text, OfAFaultIsTranslatedWhereItIsShown) {
  set_translator(german);
  EXPECT_EQ(core::to_string({{"scene.json", 3, 7}, "Paused"}), "scene.json:3:7: Angehalten");
}

}  // namespace
}  // namespace trocar
