#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/sim/recording/recording.hpp>

using namespace trocar;
using namespace trocar::sim;
namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<std::uint8_t>;

class RecordingFile : public testing::Test {
 protected:
  RecordingFile() { fs::create_directories(m_folder); }
  ~RecordingFile() override { fs::remove_all(m_folder); }
  fs::path file(const std::string& name) const { return m_folder / name; }

 private:
  fs::path m_folder = fs::path(testing::TempDir()) / ("trocar_recording_" + std::to_string(getpid()));
};

Bytes bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& path, const Bytes& bytes) {
  fs::remove(path);  // a new file: some file systems wait for the disk when an old one is overwritten
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

RecordingHeader some_header() {
  RecordingHeader header;
  header.model_hash = 0x0123456789abcdef;
  header.seed = 42;
  header.exercise = "gynaecology/sterilisation";
  header.program_version = "0.1.0";
  header.metadata_json = R"({"trainee": "Ä"})";
  return header;
}

bool same_bits(const Input& a, const Input& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Hands that rest, move one instrument, and now and then jump: what a session looks like to the coder.
std::vector<Input> session(std::size_t ticks, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<Input> inputs(ticks);
  Input now;
  for (Input& input : inputs) {
    const double dice = random.uniform();
    ToolInput& tool = now.tools[random.next() % kMaxTools];
    if (dice < 0.3) tool.yaw += float(random.uniform(-1e-3, 1e-3)), tool.depth += float(random.uniform(-1e-4, 1e-4));
    if (dice < 0.01) now.scope = {float(random.uniform(-1, 1)), -0.0f, 1e-42f, 3e38f, float(random.uniform())};
    if (dice > 0.99) now.pedals = std::uint32_t(random.next());
    input = now;
  }
  return inputs;
}

/// The usual course: inputs, a hash every 100 ticks, a keyframe every `keyframe_every` ticks, an end.
void record(const fs::path& path, const std::vector<Input>& inputs, std::uint64_t keyframe_every = kKeyframeEvery) {
  RecordingWriter writer(path, some_header());
  for (std::uint64_t tick = 0; tick < inputs.size(); ++tick) {
    if (tick % kHashEvery == 0) writer.hash(tick, tick * 0x9e3779b97f4a7c15ull);
    if (tick % keyframe_every == 0) writer.keyframe(tick, Bytes(tick % 7, std::uint8_t(tick)));
    writer.tick(tick, inputs[tick]);
  }
  writer.finish(R"({"score": 1})");
  ASSERT_EQ(writer.failure(), "");
}

/// Readable without a crash, and nothing in it that the sound recording does not have.
void expect_part_of(const Recording& part, const Recording& whole) {
  ASSERT_LE(part.inputs.size(), whole.inputs.size());
  for (std::size_t i = 0; i < part.inputs.size(); ++i) ASSERT_TRUE(same_bits(part.inputs[i], whole.inputs[i])) << i;
  ASSERT_LE(part.hashes.size(), whole.hashes.size());
  for (std::size_t i = 0; i < part.hashes.size(); ++i) ASSERT_EQ(part.hashes[i].hash, whole.hashes[i].hash);
  ASSERT_LE(part.keyframes.size(), whole.keyframes.size());
  for (std::size_t i = 0; i < part.keyframes.size(); ++i) ASSERT_EQ(part.keyframes[i].bytes, whole.keyframes[i].bytes);
}

/// Reads a damaged copy; true when its header could be read.
bool read_damaged(const fs::path& path, const Bytes& bytes, const Recording& whole) {
  write_bytes(path, bytes);
  try {
    const Recording part = read_recording(path);
    EXPECT_FALSE(part.complete);
    EXPECT_EQ(part.damage.rfind("byte ", 0), 0u) << part.damage;
    expect_part_of(part, whole);
    return true;
  } catch (const core::BadInput& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
    return false;
  }
}

}  // namespace

TEST_F(RecordingFile, TenMinutesComeBackToTheBit) {
  const std::vector<Input> inputs = session(600'000, 1);
  record(file("a"), inputs);
  const Recording read = read_recording(file("a"));
  EXPECT_TRUE(read.complete) << read.damage;
  EXPECT_EQ(read.damage, "");
  ASSERT_EQ(read.inputs.size(), inputs.size());
  EXPECT_EQ(std::memcmp(read.inputs.data(), inputs.data(), inputs.size() * sizeof(Input)), 0);
  EXPECT_EQ(read.result_json, R"({"score": 1})");
  ASSERT_EQ(read.hashes.size(), inputs.size() / kHashEvery);
  EXPECT_EQ(read.hashes[7].tick, 700u);
  EXPECT_EQ(read.hashes[7].hash, 700 * 0x9e3779b97f4a7c15ull);
  ASSERT_EQ(read.keyframes.size(), inputs.size() / kKeyframeEvery);
  EXPECT_EQ(read.keyframes[3].tick, 300u);
  EXPECT_EQ(read.keyframes[3].bytes, Bytes(300 % 7, std::uint8_t(300)));
}

TEST_F(RecordingFile, ArbitraryBitsInEveryFieldComeBack) {
  core::Random random(7);
  std::vector<Input> inputs(2500);
  for (Input& input : inputs) {
    std::uint32_t words[sizeof(Input) / 4];
    for (auto& word : words) word = std::uint32_t(random.next()) & 0xff7fffff;  // never a NaN
    std::memcpy(static_cast<void*>(&input), words, sizeof input);
  }
  record(file("a"), inputs, 5000);
  const Recording read = read_recording(file("a"));
  ASSERT_EQ(read.inputs.size(), inputs.size());
  EXPECT_EQ(std::memcmp(read.inputs.data(), inputs.data(), inputs.size() * sizeof(Input)), 0);
}

TEST_F(RecordingFile, HeaderComesBack) {
  record(file("a"), session(10, 1));
  const RecordingHeader read = read_recording(file("a")).header, wrote = some_header();
  EXPECT_EQ(read.format, kRecordingFormat);
  EXPECT_EQ(read.model_hash, wrote.model_hash);
  EXPECT_EQ(read.seed, wrote.seed);
  EXPECT_EQ(read.exercise, wrote.exercise);
  EXPECT_EQ(read.program_version, wrote.program_version);
  EXPECT_EQ(read.metadata_json, wrote.metadata_json);
}

TEST_F(RecordingFile, BytesOfFormatTwoStayWhatTheyWere) {
  record(file("a"), session(2500, 21));
  const Bytes bytes = bytes_of(file("a"));
  EXPECT_EQ(core::hash_bytes(bytes.data(), bytes.size()),
            0xd8eeb9f138c9fe68ull);  // a change needs another kRecordingFormat
}

TEST_F(RecordingFile, RestingHandsCostNearlyNothing) {
  record(file("rest"), std::vector<Input>(60'000), 100'000);
  EXPECT_LT(fs::file_size(file("rest")), 20'000u);  // a minute: 60 blocks with 600 hashes
}

TEST_F(RecordingFile, EveryFlippedByteIsNoticedAndCutsOffOnlyWhatFollows) {
  const std::vector<Input> inputs = session(350, 3);
  record(file("a"), inputs);
  const Recording whole = read_recording(file("a"));
  ASSERT_TRUE(whole.complete);
  const Bytes bytes = bytes_of(file("a"));
  std::size_t readable = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i] ^= std::uint8_t(1u << i % 8);
    readable += read_damaged(file("damaged"), damaged, whole);
  }
  EXPECT_GT(readable, bytes.size() / 2);  // only the header is indispensable
}

TEST_F(RecordingFile, EveryTruncationLeavesTheBlocksBeforeIt) {
  const std::vector<Input> inputs = session(350, 4);
  record(file("a"), inputs);
  const Recording whole = read_recording(file("a"));
  const Bytes bytes = bytes_of(file("a"));
  std::size_t last = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    if (!read_damaged(file("damaged"), Bytes(bytes.begin(), bytes.begin() + size), whole)) continue;
    const std::size_t ticks = read_recording(file("damaged")).inputs.size();
    EXPECT_GE(ticks, last);
    last = ticks;
  }
  EXPECT_EQ(last, inputs.size());
}

TEST_F(RecordingFile, BytesBehindTheEndMarkAreDamage) {
  record(file("a"), session(10, 1));
  Bytes bytes = bytes_of(file("a"));
  bytes.push_back(0);
  write_bytes(file("a"), bytes);
  const Recording read = read_recording(file("a"));
  EXPECT_FALSE(read.complete);
  EXPECT_EQ(read.inputs.size(), 10u);
}

TEST_F(RecordingFile, RandomBytesAreRefused) {
  core::Random random(5);
  for (int size = 0; size < 200; ++size) {
    Bytes bytes(size);
    for (auto& byte : bytes) byte = std::uint8_t(random.next());
    write_bytes(file("noise"), bytes);
    EXPECT_THROW(read_recording(file("noise")), core::BadInput);
  }
}

TEST_F(RecordingFile, AFolderOrAMissingFileIsRefused) {
  EXPECT_THROW(read_recording(file("")), core::BadInput);
  EXPECT_THROW(read_recording(file("missing")), core::BadInput);
  EXPECT_THROW(read_recording("/dev/zero"), core::BadInput);
}

TEST_F(RecordingFile, AnotherFormatIsRefusedByNumber) {
  RecordingHeader header = some_header();
  header.format = 1;
  { RecordingWriter writer(file("a"), header); }
  try {
    read_recording(file("a"));
    FAIL();
  } catch (const core::BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("expected recording format 2, got 1"), std::string::npos);
  }
}

TEST_F(RecordingFile, AFlippedInputBitInASoundFileChangesThatInputOnly) {
  const std::vector<Input> inputs = session(3000, 9);
  std::vector<Input> changed = inputs;
  auto* bytes = reinterpret_cast<unsigned char*>(&changed[1234].tools[2].depth);
  bytes[0] ^= 1;
  record(file("a"), inputs);
  record(file("b"), changed);
  const Recording a = read_recording(file("a")), b = read_recording(file("b"));
  ASSERT_TRUE(a.complete && b.complete);
  for (std::size_t i = 0; i < inputs.size(); ++i) EXPECT_EQ(same_bits(a.inputs[i], b.inputs[i]), i != 1234) << i;
}

TEST_F(RecordingFile, AKilledProcessLosesLessThanASecond) {
  const std::vector<Input> inputs = session(5700, 11);
  const pid_t child = fork();
  if (child == 0) {
    RecordingWriter writer(file("a"), some_header());
    for (std::uint64_t tick = 0; tick < inputs.size(); ++tick) writer.tick(tick, inputs[tick]);
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  const Recording read = read_recording(file("a"));
  EXPECT_FALSE(read.complete);
  EXPECT_NE(read.damage.find("interrupted"), std::string::npos);
  EXPECT_EQ(read.inputs.size(), 5000u);
  for (std::size_t i = 0; i < read.inputs.size(); ++i) ASSERT_TRUE(same_bits(read.inputs[i], inputs[i]));
}

TEST_F(RecordingFile, WithoutFinishItReadsAsInterruptedButWhole) {
  const std::vector<Input> inputs = session(150, 2);
  {
    RecordingWriter writer(file("a"), some_header());
    for (std::uint64_t tick = 0; tick < inputs.size(); ++tick) writer.tick(tick, inputs[tick]);
  }
  const Recording read = read_recording(file("a"));
  EXPECT_FALSE(read.complete);
  EXPECT_EQ(read.inputs.size(), inputs.size());
  EXPECT_EQ(read.result_json, "");
}

TEST_F(RecordingFile, AFullDiskAtTheStartIsAnEnvironmentThatLacksSpace) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(RecordingWriter("/dev/full", some_header()), core::EnvironmentLacks);
  EXPECT_THROW(RecordingWriter(file("no/such/folder"), some_header()), core::EnvironmentLacks);
}

TEST_F(RecordingFile, ADiskThatFillsUpEndsTheRecordingWithoutAThrow) {
  const std::vector<Input> inputs = session(20'000, 13);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 50'000;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string failure;
  {
    RecordingWriter writer(file("a"), some_header());
    for (std::uint64_t tick = 0; tick < inputs.size(); ++tick) writer.tick(tick, inputs[tick]), writer.hash(tick, 1);
    writer.finish("{}");
    failure = writer.failure();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(failure.find(file("a").string()), std::string::npos) << failure;
  const Recording read = read_recording(file("a"));
  EXPECT_FALSE(read.complete);
  EXPECT_GE(read.inputs.size(), 1000u);
  for (std::size_t i = 0; i < read.inputs.size(); ++i) ASSERT_TRUE(same_bits(read.inputs[i], inputs[i]));
}

TEST_F(RecordingFile, TicksOutOfOrderAreAFailureNotAWrongReplay) {
  RecordingWriter gap(file("gap"), some_header());
  gap.tick(0, {});
  gap.tick(2, {});
  EXPECT_NE(gap.failure().find("expected tick 1, got 2"), std::string::npos);
  RecordingWriter early(file("early"), some_header());
  early.tick(0, {});
  early.hash(2, 0);
  EXPECT_NE(early.failure().find("expected a tick up to 1, got 2"), std::string::npos);
}

TEST_F(RecordingFile, NothingIsWrittenBehindTheEnd) {
  RecordingWriter writer(file("a"), some_header());
  writer.tick(0, {});
  writer.finish("{}");
  const auto size = fs::file_size(file("a"));
  writer.tick(1, {});
  writer.keyframe(0, Bytes(100));
  writer.flush();
  EXPECT_EQ(fs::file_size(file("a")), size);
  EXPECT_TRUE(read_recording(file("a")).complete);
}
