// Images at one position, told apart by what DICOM says of them.
#include <gtest/gtest.h>

#include <trocar/volumes/files/image_groups.hpp>

namespace trocar::volumes {
namespace {

/// Images in the order of their positions: `each` of them at every one of `positions`, marked by `mark`.
struct Images {
  std::vector<std::vector<int>> levels;
  std::vector<Marks> marks;

  template <class Set>
  void add(int position, Set&& set) {
    if (std::size_t(position) >= levels.size()) levels.resize(std::size_t(position) + 1);
    levels[std::size_t(position)].push_back(int(marks.size()));
    set(marks.emplace_back());
  }
  ImageGroups told() const { return grouped(levels, marks); }
};

}  // namespace

TEST(ImageGroups, AnAcquisitionIsAGroupWhateverOrderItsImagesAreIn) {
  Images images;
  for (const auto& [position, acquisition] : {std::pair{0, "10"}, {0, "9"}, {1, "9"}, {1, "10"}})
    images.add(position, [&, a = acquisition](Marks& m) { m[Mark::acquisition] = a; });
  const ImageGroups told = images.told();
  EXPECT_TRUE(told.alike);
  EXPECT_EQ(told.told_by, "Acquisition Number");
  ASSERT_EQ(told.groups.size(), 2u);
  EXPECT_EQ(told.groups[0].name, "Acquisition Number 9") << "numbers go by their size";
  EXPECT_EQ(told.groups[0].images, (std::vector<int>{1, 2}));
}

TEST(ImageGroups, TheEarliestComesFirstWhateverItsNumber) {
  Images images;
  for (int k = 0; k < 2; ++k)
    for (const auto& [number, time] : {std::pair{"1", "10:05:00.000"}, {"2", "10:00:00.000"}})
      images.add(k, [&, n = number, t = time](Marks& m) { m[Mark::acquisition] = n, m[Mark::acquisition_time] = t; });
  EXPECT_EQ(images.told().groups.at(0).name, "Acquisition Number 2");
}

TEST(ImageGroups, EchoesInMagnitudeAndPhaseNeedBothMarks) {
  Images images;
  for (int k = 0; k < 3; ++k)
    for (const char* echo : {"4.6", "9.2"})
      for (const char* type : {"M", "P"})
        images.add(k, [&](Marks& m) { m[Mark::echo_time] = echo, m[Mark::image_type] = type; });
  const ImageGroups told = images.told();
  ASSERT_EQ(told.groups.size(), 4u);
  EXPECT_EQ(told.told_by, "Echo Time, Image Type");
  EXPECT_EQ(told.groups[1].name, "Echo Time 4.6, Image Type P");
  EXPECT_EQ(told.groups[1].images, (std::vector<int>{1, 5, 9}));
}

TEST(ImageGroups, TimesThatDifferFromSliceToSliceCountByTheirOrder) {
  Images images;
  for (int k = 0; k < 3; ++k)
    for (const int phase : {2, 0, 1})
      images.add(k, [&](Marks& m) {
        m[Mark::trigger_time] = std::to_string(31 * phase + k);
        m[Mark::acquisition] = std::to_string(k);  // of the slice, not of the phase
      });
  const ImageGroups told = images.told();
  ASSERT_EQ(told.groups.size(), 3u);
  EXPECT_EQ(told.told_by, "Trigger Time");
  EXPECT_EQ(told.groups[0].images, (std::vector<int>{1, 4, 7}));
  EXPECT_EQ(told.groups[2].images, (std::vector<int>{0, 3, 6}));
}

TEST(ImageGroups, AcquisitionsOfUnlikeExtentAreNoTimePoints) {
  Images images;
  for (int k = 0; k < 4; ++k) images.add(k, [](Marks& m) { m[Mark::acquisition] = "1"; });
  for (int k = 2; k < 8; ++k) images.add(k, [](Marks& m) { m[Mark::acquisition] = "2"; });
  const ImageGroups told = images.told();
  EXPECT_FALSE(told.alike);
  ASSERT_EQ(told.groups.size(), 2u);
  EXPECT_EQ(told.groups[0].images.size(), 4u);
  EXPECT_EQ(told.groups[1].images.size(), 6u);
}

TEST(ImageGroups, ImagesThatNothingTellsApartStayTogether) {
  Images images;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 2; ++i)
      images.add(k, [&](Marks& m) { m[Mark::instance] = std::to_string(k), m[Mark::acquisition] = "1"; });
  EXPECT_TRUE(images.told().groups.empty());
  Images each;  // a mark of each image of its own parts nothing
  for (const int k : {0, 0, 1})
    each.add(k, [&](Marks& m) { m[Mark::acquisition_time] = std::to_string(each.marks.size()); });
  EXPECT_TRUE(each.told().groups.empty());
}

TEST(ImageGroups, MarksAreInOrderNumbersFirst) {
  EXPECT_TRUE(mark_less("9", "10"));
  EXPECT_TRUE(mark_less("10", "1x"));
  EXPECT_FALSE(mark_less("1x", "9"));
  EXPECT_FALSE(mark_less("7", "7"));
}

}  // namespace trocar::volumes
