// The recording reader. Blind changes would stop at the first checksum, so the mutation writes the checksums anew.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include <trocar/attempt/verification/result_check.hpp>
#include <trocar/attempt/verification/state_check.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "targets.hpp"

namespace trocar::fuzz {
namespace {

constexpr std::size_t kSignature = 8, kHead = 40, kCheckedHead = 32;

std::uint64_t number_at(const std::uint8_t* p) {
  std::uint64_t value;
  std::memcpy(&value, p, sizeof value);
  return value;
}

/// Where each block begins, as far as the sizes lead.
std::vector<std::size_t> blocks_of(Bytes bytes) {
  std::vector<std::size_t> begins;
  for (std::size_t at = kSignature; at < bytes.size() && bytes.size() - at >= kHead;) {
    const std::uint64_t size = number_at(&bytes[at + 24]);
    if (size > bytes.size() - at - kHead) break;
    begins.push_back(at);
    at += kHead + std::size_t(size);
  }
  return begins;
}

void seal(std::uint8_t* block) {
  const std::uint64_t sum =
      core::hash_bytes(block + kHead, std::size_t(number_at(block + 24)), core::hash_bytes(block, kCheckedHead));
  std::memcpy(block + kCheckedHead, &sum, sizeof sum);
}

/// A small recording with every kind of block.
std::vector<std::uint8_t> sample(int ticks, bool finished) {
  const std::string path = std::string(TROCAR_BINARY_DIR) + "/fuzz-seed-" + std::to_string(ticks) + ".rec";
  {
    sim::RecordingHeader header;
    header.model_hash = 0x1234;
    header.exercise = "gynaecology/sterilisation";
    header.program_version = "0.1.0";
    header.metadata_json = "{\"trainee\": \"a\"}";
    sim::RecordingWriter writer(path, header);
    sim::Input input;
    for (int t = 0; t < ticks; ++t) {
      if (t % 3 == 0) input.tools[0].depth += 0.001f;
      if (t % 100 == 0) {
        writer.hash(std::uint64_t(t), 77u * std::uint64_t(t));
        writer.keyframe(std::uint64_t(t), std::vector<std::uint8_t>(20, std::uint8_t(t)));
      }
      writer.tick(std::uint64_t(t), input);
    }
    if (finished)
      writer.finish(
          R"({"passed":true,"ticks":1,"assessment":{"score":{"total":90},"steps":[],"errors":[{"code":"E"}]}})");
  }
  std::stringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  std::remove(path.c_str());
  return bytes_of(bytes.str());
}

}  // namespace

void recording_file(Bytes bytes) {
  try {
    const sim::Recording r = sim::read_recording(bytes, "memory");
    require(r.header.format == sim::kRecordingFormat, "only this format is read");
    require(r.inputs.size() <= sim::kMaxTicks, "a recording has an end");
    for (const sim::HashMark& mark : r.hashes)
      require(mark.tick <= r.inputs.size(), "a hash is of a tick that is there");
    for (const sim::Keyframe& k : r.keyframes)
      require(k.tick <= r.inputs.size(), "a keyframe is of a tick that is there");
    require(r.complete == r.damage.empty(), "what is not complete is said");
    require(!(r.complete && r.interrupted), "complete is not interrupted");
    const bool marked = attempt::fault_of_hashes(r).empty();
    static_cast<void>(attempt::fault_of_keyframes(r));
    require(!marked || !r.complete || (!r.hashes.empty() && r.hashes.back().tick == r.inputs.size()),
            "a recording without a fault of its marks is covered to its end");
    static_cast<void>(attempt::was_aborted(r)), static_cast<void>(training::exercise_hash_in(r.header.metadata_json));
    static_cast<void>(attempt::first_difference(Json::parse(r.result_json, nullptr, false), Json::object()));
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty() && !bad.faults().front().message.empty(), "a refusal has a reason");
  }
}

std::vector<Seed> recording_seeds() {
  return {{"one", sample(1, true)}, {"interrupted", sample(250, false)}, {"finished", sample(310, true)}};
}

std::size_t mutate_recording(std::uint8_t* data, std::size_t size, std::size_t capacity, unsigned seed) {
  core::Random random(seed);
  const std::vector<std::size_t> blocks = blocks_of({data, size});
  if (blocks.empty() || random.next() % 8 == 0) return plain_mutation(data, size, capacity);
  const auto some = [&](std::size_t n) { return std::size_t(random.next() % n); };
  const std::size_t at = blocks[some(blocks.size())], whole = kHead + std::size_t(number_at(data + at + 24));
  std::uint8_t* block = data + at;
  switch (some(5)) {
    case 0: {  // a field of the head: kind, first tick, count
      const std::size_t field = 4 + 4 * some(5);
      const std::uint64_t value = random.next() >> some(64);
      std::memcpy(block + field, &value, 4);
      break;
    }
    case 1:  // a block twice
      if (size + whole <= capacity) {
        std::memmove(block + whole, block, size - at);
        return size + whole;
      }
      break;
    case 2:  // a block less
      std::memmove(block, block + whole, size - at - whole);
      return size - whole;
    case 3: {  // another size: the blocks behind follow
      const std::size_t longest = std::min<std::size_t>(whole - kHead + 64, capacity - size + whole - kHead);
      std::vector<std::uint8_t> payload(block + kHead, block + whole);
      payload.resize(std::max<std::size_t>(longest, payload.size()));
      const std::size_t now = plain_mutation(payload.data(), whole - kHead, payload.size());
      if (size - whole + kHead + now > capacity) break;
      std::memmove(block + kHead + now, block + whole, size - at - whole);
      std::copy(payload.begin(), payload.begin() + std::ptrdiff_t(now), block + kHead);
      const std::uint64_t length = now;
      std::memcpy(block + 24, &length, sizeof length);
      seal(block);
      return size - whole + kHead + now;
    }
    default:  // bytes of the payload
      if (whole > kHead)
        for (std::size_t n = 1 + some(4); n > 0; --n) block[kHead + some(whole - kHead)] = std::uint8_t(random.next());
  }
  seal(block);
  return size;
}

}  // namespace trocar::fuzz
