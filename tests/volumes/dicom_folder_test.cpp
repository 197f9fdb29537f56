// Folders that can be read in part only: slices may be missing by it, so that notes name what was not read.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <trocar/volumes/files/dicom_folder.hpp>

#include "made_dicom.hpp"

namespace trocar::volumes {
namespace {

namespace fs = std::filesystem;

/// The process can open one more file, and no second one at the same time.
class OneFileAtATime {
 public:
  OneFileAtATime() {
    const int next = ::open("/dev/null", O_RDONLY);
    ::close(next);
    ::getrlimit(RLIMIT_NOFILE, &m_was);
    const rlimit fewer{rlim_t(next) + 1, m_was.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &fewer);
  }
  ~OneFileAtATime() { ::setrlimit(RLIMIT_NOFILE, &m_was); }
  OneFileAtATime(const OneFileAtATime&) = delete;
  OneFileAtATime& operator=(const OneFileAtATime&) = delete;

 private:
  rlimit m_was{};
};

TEST_F(MadeDicom, AFolderThatCannotBeReadIsNamed) {
  for (int k = 0; k < 5; ++k) write(fmt::format("{}/IM{}.dcm", k < 3 ? "series/a" : "series/other", k), slice(k, k));
  const auto read = [&](const char* folder) {
    const OneFileAtATime limit;
    return read_dicom_folder(m_folder / folder, {});
  };
  const DicomFolder all = read("series");
  EXPECT_EQ(all.files.size(), 0u);
  ASSERT_EQ(all.left_out.size(), 2u);
  for (const LeftOut& left : all.left_out) EXPECT_TRUE(left.broken && left.dicom);
  const std::vector<std::string> notes = notes_on(all.left_out);
  ASSERT_EQ(notes.size(), 1u);
  expect_words(notes[0], "left out: a, other (expected a folder that can be read, got ");
  EXPECT_EQ(read("series/a").files.size(), 3u);
  EXPECT_EQ(read("series/a").left_out.size(), 0u);
}

TEST_F(MadeDicom, ALinkWithoutItsFileIsNamed) {
  for (int k = 0; k < 5; ++k) write(fmt::format("IM{}.dcm", k), slice(k, k));
  fs::remove(m_folder / "IM4.dcm");
  fs::create_symlink("elsewhere", m_folder / "IM4.dcm");
  expect_words(notes_of(read_volume(m_folder)), "left out: IM4.dcm (expected a file that can be read, got ");
  expect_words(notes_of(read_volume(m_folder / "IM0.dcm")), "left out: IM4.dcm (");
  fs::remove(m_folder / "IM2.dcm");
  fs::create_symlink("elsewhere", m_folder / "IM2.dcm");
  fs::remove(m_folder / "IM4.dcm");
  write("IM4.dcm", slice(4, 4));
  expect_words(fault(), "missing at 4.00");
  expect_words(fault(), "IM2.dcm: expected a file that can be read");
}

TEST_F(MadeDicom, FoldersTooFarDownAreNamed) {
  for (int k = 0; k < 3; ++k) write(fmt::format("1/2/3/4/5/6/IM{}.dcm", k), slice(k, k));
  EXPECT_EQ(notes_of(read_volume(m_folder)), "");
  write("1/2/3/4/5/6/seventh/IM3.dcm", slice(3, 3));
  const VolumeFile read = read_volume(m_folder);
  EXPECT_EQ(read.volume.grid.size[2], 3);
  expect_words(notes_of(read), "left out: seventh (a folder more than 6 levels down: open it itself)");
  EXPECT_EQ(notes_of(read_volume(m_folder / "1/2/3/4/5/6/IM0.dcm")), "");
}

}  // namespace
}  // namespace trocar::volumes
