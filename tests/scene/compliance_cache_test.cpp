// Compliances kept on disk: what is read is what was made, and what is damaged, foreign or cannot be written does no
// harm.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/core/hash.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/cache/compliance_cache.hpp>

#include "../sim/small_scene.hpp"
#include "files.hpp"

using namespace trocar;
using namespace trocar::scene;

namespace fs = std::filesystem;

namespace {

/// A folder of this test's own for the cache.
class Cache {
 public:
  Cache() {
    if (const char* before = std::getenv("TROCAR_CACHE")) m_before = before;
    ::setenv("TROCAR_CACHE", m_folder.path().c_str(), 1);
  }
  ~Cache() { m_before.empty() ? ::unsetenv("TROCAR_CACHE") : ::setenv("TROCAR_CACHE", m_before.c_str(), 1); }

  std::vector<fs::path> files() const {
    std::vector<fs::path> all;
    for (const fs::directory_entry& e : fs::directory_iterator(m_folder.path())) all.push_back(e.path());
    std::sort(all.begin(), all.end());
    return all;
  }
  const fs::path& path() const { return m_folder.path(); }

 private:
  Folder m_folder;
  std::string m_before;
};

/// One organ, held rigidly.
Description one_organ() {
  Description d = small::description();
  d.solids = {small::organ()};
  d.strands.clear();
  d.membranes.clear();
  d.vessels.clear();
  d.fluids.reset();
  d.solids[0].solver = Solver::elastostatic;
  return d;
}

struct Compiled {
  sim::Model model;
  ComplianceReport report;
};
Compiled compiled(const Description& d = one_organ()) {
  CompileReport report;
  Compiled out{compile(d, &report), {}};
  out.report = report.compliances.at(0);
  return out;
}

void change_byte(const fs::path& path, std::streamoff at) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(at);
  const char byte = char(file.get() ^ 0x10);
  file.seekp(at);
  file.put(byte);
}

TEST(ComplianceCache, WhatIsReadIsWhatWasMade) {
  const Cache cache;
  const Compiled made = compiled(), read = compiled();
  EXPECT_TRUE(made.report.computed);
  EXPECT_FALSE(read.report.computed);
  EXPECT_EQ(made.model.hash, read.model.hash);
  EXPECT_EQ(made.report.file, read.report.file);
  EXPECT_EQ(cache.files().size(), 1u);
  EXPECT_GT(made.report.kept, 30);
  EXPECT_LE(made.report.kept, made.report.nodes);
}

TEST(ComplianceCache, AnotherMaterialIsAnotherFile) {
  const Cache cache;
  Description other = one_organ();
  other.tissues[0].young *= 1.001;
  EXPECT_NE(compiled().report.file, compiled(other).report.file);
  EXPECT_EQ(cache.files().size(), 2u);
}

TEST(ComplianceCache, AFlippedByteAnywhereIsFoundAndTheFileMadeAnew) {
  const Cache cache;
  const Compiled made = compiled();
  const fs::path file = cache.files().at(0);
  const auto size = std::streamoff(fs::file_size(file));
  for (const std::streamoff at : {std::streamoff(0), std::streamoff(9), std::streamoff(13), std::streamoff(17),
                                  std::streamoff(33), std::streamoff(41), std::streamoff(60), size / 2, size - 1}) {
    change_byte(file, at);
    const Compiled again = compiled();
    EXPECT_TRUE(again.report.computed) << at;
    EXPECT_NE(again.report.note, "") << at;
    EXPECT_EQ(again.model.hash, made.model.hash) << at;
    EXPECT_FALSE(compiled().report.computed) << at << ": the new file is sound";
  }
}

/// Another figure for one of the file's, with its checksum made again: as somebody would hand it in.
void change_figures(const fs::path& path, const std::function<void(std::vector<float>&)>& change) {
  constexpr std::size_t kHeader = 48, kKept = 32, kSum = 40;
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  in.close();
  std::uint32_t kept = 0;
  std::memcpy(&kept, bytes.data() + kKept, sizeof kept);
  const std::size_t count = 9 * std::size_t(kept) * kept;
  std::vector<float> columns(count), fields((bytes.size() - kHeader) / sizeof(float) - count);
  std::memcpy(columns.data(), bytes.data() + kHeader, count * sizeof(float));
  if (!fields.empty())
    std::memcpy(fields.data(), bytes.data() + kHeader + count * sizeof(float), fields.size() * sizeof(float));
  change(columns);
  core::Hasher sum;
  sum.add(columns);
  sum.add(fields);
  const std::uint64_t value = sum.value();
  std::memcpy(bytes.data() + kHeader, columns.data(), count * sizeof(float));
  std::memcpy(bytes.data() + kSum, &value, sizeof value);
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(ComplianceCache, WhatIsNotTheBodysIsFoundHoweverItIsSealed) {
  const Cache cache;
  const std::uint64_t made = compiled().model.hash;
  const fs::path file = cache.files().at(0);
  const auto expect_found = [&](const char* says, const std::function<void(std::vector<float>&)>& change) {
    change_figures(file, change);
    const Compiled again = compiled();
    EXPECT_TRUE(again.report.computed) << says;
    EXPECT_NE(again.report.note.find(says), std::string::npos) << again.report.note;
    EXPECT_EQ(again.model.hash, made) << says;
    EXPECT_FALSE(compiled().report.computed) << "it was made again: " << says;
  };
  const auto row = [](const std::vector<float>& c) { return std::size_t(std::sqrt(double(c.size()))); };
  expect_found("not the compliance of this body", [](std::vector<float>& c) {
    for (float& v : c) v *= 10;
  });
  expect_found("diagonal is not positive", [](std::vector<float>& c) {
    for (float& v : c) v = -v;
  });
  expect_found("not finite", [](std::vector<float>& c) { c[7] = std::numeric_limits<float>::quiet_NaN(); });
  expect_found("not symmetric", [](std::vector<float>& c) { c[1] += 0.1f * c[0]; });
  expect_found("not the compliance of this body", [&row](std::vector<float>& c) {
    const std::size_t n = row(c), i = n / 2, j = i + 1;  // two figures that agree with each other
    c[i * n + j] = c[j * n + i] = c[i * n + j] + 0.5f * c[i * n + i];
  });
  change_figures(file, [](std::vector<float>&) {});
  EXPECT_FALSE(compiled().report.computed) << "unchanged it is taken";
}

TEST(ComplianceCache, AFileThatEndsEarlyOrIsSomethingElseCountsAsNone) {
  const Cache cache;
  const Compiled made = compiled();
  const fs::path file = cache.files().at(0);
  const std::string whole = text_of(file);
  for (const std::string& bytes : {std::string(), whole.substr(0, 20), whole.substr(0, whole.size() - 4),
                                   whole + "more", std::string(whole.size(), 'x')}) {
    std::ofstream(file, std::ios::binary) << bytes;
    const Compiled again = compiled();
    EXPECT_TRUE(again.report.computed) << bytes.size();
    EXPECT_EQ(again.model.hash, made.model.hash);
  }
  fs::remove(file);
  fs::create_directory(file);  // a folder in its place
  EXPECT_EQ(compiled().model.hash, made.model.hash);
}

TEST(ComplianceCache, WithoutAPlaceToKeepItItIsMadeEveryTime) {
  const Cache cache;
  const Compiled made = compiled();
  const fs::path blocked = cache.path() / "blocked";
  std::ofstream(blocked) << "a file where the folder should be";
  ::setenv("TROCAR_CACHE", (blocked / "cache").c_str(), 1);
  for (int i = 0; i < 2; ++i) {
    const Compiled again = compiled();
    EXPECT_TRUE(again.report.computed);
    EXPECT_EQ(again.report.file, "");
    EXPECT_NE(again.report.note.find("cannot write"), std::string::npos) << again.report.note;
    EXPECT_EQ(again.model.hash, made.model.hash);
  }
  ::setenv("TROCAR_CACHE", "/dev/full", 1);  // writing fails, not opening
  EXPECT_EQ(compiled().model.hash, made.model.hash);
}

TEST(ComplianceCache, WhatWasNotUsedForLongestGoesFirst) {
  const Cache cache;
  const auto now = fs::file_time_type::clock::now();
  for (int i = 0; i < 4; ++i) {
    const fs::path file = cache.path() / (std::to_string(i) + ".compliance");
    std::ofstream(file) << std::string(100, 'x');
    fs::last_write_time(file, now - std::chrono::hours(10 - i));
  }
  std::ofstream(cache.path() / "somebody's.txt") << std::string(1000, 'x');
  trim_compliances(cache.path(), 250);
  const std::vector<fs::path> left = cache.files();
  ASSERT_EQ(left.size(), 3u);
  EXPECT_EQ(left[0].filename(), "2.compliance");
  EXPECT_EQ(left[1].filename(), "3.compliance");
  EXPECT_EQ(left[2].filename(), "somebody's.txt");
}

TEST(ComplianceCache, ProgressIsTold) {
  const Cache cache;
  CompileReport report;
  std::vector<double> shares;
  report.said = [&](const std::string& organ, double share) {
    EXPECT_EQ(organ, "organ");
    shares.push_back(share);
  };
  compile(one_organ(), &report);
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
}

}  // namespace
