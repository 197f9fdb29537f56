// Every input of the kept corpora, and every input that once was a fault, through its target: without a fuzzer, with
// any compiler.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/scene/files/reader.hpp>

#include "archive.hpp"
#include "json_mutation.hpp"
#include "targets.hpp"

namespace trocar::fuzz {

std::size_t plain_mutation(std::uint8_t*, std::size_t size, std::size_t) { return size; }

namespace {

namespace fs = std::filesystem;

std::vector<Seed> files_in(const fs::path& folder) {
  std::vector<Seed> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    std::stringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    files.push_back({entry.path().filename().string(), bytes_of(text.str())});
  }
  std::sort(files.begin(), files.end(), [](const Seed& a, const Seed& b) { return a.name < b.name; });
  return files;
}

class Replay : public testing::TestWithParam<Target> {};

void replay(const Target& target, const std::vector<Seed>& inputs) {
  for (const Seed& input : inputs) {
    SCOPED_TRACE(input.name);
    EXPECT_NO_THROW(target.run(input.bytes));
  }
}

TEST_P(Replay, WhatOnceWasAFaultIsNoneAnyMore) {
  replay(GetParam(), files_in(fs::path(TROCAR_FUZZ_FOUND) / GetParam().name));
}

TEST_P(Replay, TheKeptCorpusKeepsEveryPromise) {
  const std::vector<Seed> corpus = files_in(fs::path(TROCAR_FUZZ_CORPUS) / GetParam().name);
  EXPECT_GT(corpus.size(), 10u) << "tests/fuzz/corpus/" << GetParam().name << ".tar.xz";
  replay(GetParam(), corpus);
}

TEST_P(Replay, SeedsAndTheirOwnMutationsKeepEveryPromise) {
  const Target& target = GetParam();
  const std::vector<Seed> seeds = target.seeds();
  ASSERT_FALSE(seeds.empty());
  replay(target, seeds);
  if (!target.mutate) return;
  unsigned number = 0;
  for (const Seed& seed : seeds)
    for (int round = 0; round < 20; ++round) {
      SCOPED_TRACE(seed.name + " mutation " + std::to_string(++number));
      std::vector<std::uint8_t> bytes = seed.bytes;
      bytes.resize(std::max(target.longest, bytes.size()));
      bytes.resize(target.mutate(bytes.data(), seed.bytes.size(), bytes.size(), number));
      EXPECT_NO_THROW(target.run(bytes));
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(FuzzTargets, ABrokenPromiseIsAFault) { EXPECT_THROW(require(false, "such as this"), Broken); }

TEST(FuzzTargets, ArchivesPackAndUnpack) {
  const scene::MemoryFiles files{{kMainFile, "{}\n"}, {"b.json", "1\n2\n"}, {"../c.json", ""}};
  EXPECT_EQ(unpacked(packed(files)), files);
}

TEST(FuzzTargets, SeedsOfScenesReadWell) {
  for (const Seed& seed : compile_seeds()) {
    const scene::MemoryFiles files = unpacked(text_of(seed.bytes));
    EXPECT_NO_THROW(scene::read_scene(kMainFile, &files)) << seed.name;
    EXPECT_TRUE(quick_to_compile(scene::read_scene(kMainFile, &files))) << seed.name;
  }
  const scene::MemoryFiles shipped = unpacked(text_of(scene_seeds().front().bytes));
  EXPECT_NO_THROW(scene::read_scene(kMainFile, &shipped));
}

TEST(FuzzTargets, MutationsOfJsonAreJson) {
  const Seed seed = compile_seeds().front();
  int readable = 0;
  for (unsigned number = 1; number <= 50; ++number) {
    std::vector<std::uint8_t> bytes(200'000);
    std::copy(seed.bytes.begin(), seed.bytes.end(), bytes.begin());
    bytes.resize(mutate_json(bytes.data(), seed.bytes.size(), bytes.size(), number));
    std::vector<core::Fault> faults;
    scene::parse_json(text_of(bytes), "m", faults);
    readable += faults.empty() && bytes != seed.bytes;
  }
  EXPECT_GT(readable, 35);
}

}  // namespace
}  // namespace trocar::fuzz
