// What the fuzzer runs: one function per kind of outside input, which takes any bytes. A target may refuse its input in
// the way that the reader documents; a crash, a hang, too much memory, or a promise that does not hold is a fault.
//
//   fuzz::find("scene")->run(bytes);     // throws fuzz::Broken, or does not come back, where something is wrong
//
// The same functions are built twice: with clang's libFuzzer and sanitizers (preset "fuzz", tools/fuzz.sh), and into
// the quick tests, which replay the kept corpora and every input that once was a fault (docs/developers/robustness.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A promise that did not hold.
class Broken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
inline void require(bool holds, const char* promise) {
  if (!holds) throw Broken(promise);
}

/// A mutation that knows the format: changes `data` of `size` bytes in place, at most `capacity` bytes; the new size.
using Mutate = std::size_t (*)(std::uint8_t* data, std::size_t size, std::size_t capacity, unsigned seed);
/// Makes one input of two.
using Cross = std::size_t (*)(Bytes a, Bytes b, std::uint8_t* out, std::size_t capacity, unsigned seed);

struct Seed {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

struct Target {
  const char* name;
  void (*run)(Bytes);
  std::size_t longest;                            ///< bytes of an input; longer ones are cut
  std::vector<Seed> (*seeds)();                   ///< what the corpus starts from
  std::vector<std::string> (*words)() = nullptr;  ///< the fuzzer's dictionary
  Mutate mutate = nullptr;                        ///< null: the fuzzer's own
  Cross cross = nullptr;
};
inline void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }  // its name in test reports
std::span<const Target> targets();
const Target* find(std::string_view name);

/// The fuzzer's own mutation of bytes; in the replayer, which mutates nothing, the bytes as they are.
std::size_t plain_mutation(std::uint8_t* data, std::size_t size, std::size_t capacity);

inline std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }
inline std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

}  // namespace trocar::fuzz
