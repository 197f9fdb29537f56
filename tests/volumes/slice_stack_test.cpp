#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/volumes/files/slice_stack.hpp>

namespace trocar::volumes {
namespace {

const Vec3d kRow{1, 0, 0}, kColumn{0, 1, 0};

std::vector<SlicePlace> slices_at(const std::vector<double>& along) {
  std::vector<SlicePlace> out;
  for (const double z : along) out.push_back({{3, 4, z}, 3});
  return out;
}
std::string fault_of(const std::vector<SlicePlace>& places) {
  std::vector<std::string> notes;
  try {
    stack_slices(places, kRow, kColumn, "series", notes);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}

}  // namespace

TEST(SliceStack, PositionsAndNotNumbersGiveTheOrder) {
  std::vector<std::string> notes;
  const auto places = slices_at({4, 0, 8, 2, 6});
  const SliceStack stack = stack_slices(places, kRow, kColumn, "series", notes);
  EXPECT_EQ(stack.order, (std::vector<int>{1, 3, 0, 4, 2}));
  EXPECT_EQ(stack.step, (Vec3d{0, 0, 2}));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("2 mm apart by their positions, which counts, and 3 mm thick"), std::string::npos);
}

TEST(SliceStack, MissingSlicesAreNamedByTheirPlace) {
  EXPECT_NE(fault_of(slices_at({0, 2, 4, 8, 10, 12, 18})).find("missing at 6.00, 14.00, 16.00 mm"), std::string::npos);
  EXPECT_NE(fault_of(slices_at({0, 2, 3.1, 5.2, 7})).find("expected slices evenly"), std::string::npos);
  EXPECT_EQ(fault_of(slices_at({0, 0.6, 1.3, 1.9, 2.5})), "");  // 0.625 mm, rounded to tenths
}

TEST(SliceStack, ImagesAtOnePositionAreALevelAndNoStack) {
  const auto places = slices_at({2, 0, 2.005, 0});
  EXPECT_EQ(levels_of(places, {0, 0, 1}), (std::vector<std::vector<int>>{{1, 3}, {0, 2}}));
  EXPECT_NE(fault_of(places).find("expected one image at each position, got 2 at 0.00 mm"), std::string::npos);
}

TEST(SliceStack, ATiltedGantryGivesAStepThatIsNotAlongTheNormal) {
  std::vector<std::string> notes;
  std::vector<SlicePlace> places;
  for (int k = 0; k < 5; ++k) places.push_back({{0, 0.5 * k, 2.0 * k}, 2});
  EXPECT_EQ(stack_slices(places, kRow, kColumn, "series", notes).step, (Vec3d{0, 0.5, 2}));
  places[2].position.y += 1;
  EXPECT_NE(fault_of(places).find("in a straight line"), std::string::npos);
}

}  // namespace trocar::volumes
