#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/render/frame/image.hpp>

namespace trocar::render {
namespace {

TEST(Image, PngKeepsEveryByte) {
  Image image{7, 5, {}};
  for (int i = 0; i < 7 * 5 * 3; ++i) image.rgb.push_back(std::uint8_t(i * 37));
  const std::string path = testing::TempDir() + "/trocar_image_test.png";
  write_png(path, image);
  const Image back = read_png(path);
  EXPECT_EQ(back.width, 7);
  EXPECT_EQ(back.height, 5);
  EXPECT_EQ(back.rgb, image.rgb);
  std::remove(path.c_str());
}

TEST(Image, SaysWhichFileCouldNotBeWritten) {
  const Image image{1, 1, {1, 2, 3}};
  try {
    write_png("/nonexistent/folder/a.png", image);
    FAIL();
  } catch (const core::EnvironmentLacks& e) {
    EXPECT_NE(std::string(e.what()).find("/nonexistent/folder/a.png"), std::string::npos);
  }
}

TEST(Image, RefusesAFileThatIsNoPicture) {
  const std::string path = testing::TempDir() + "/trocar_no_picture.png";
  std::ofstream(path) << "no picture";
  EXPECT_THROW(read_png(path), core::BadInput);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace trocar::render
