// Inputs of successive ticks in few bytes: what a recording's blocks hold and what travels to who plays along. Entries
// of a varint mask of the fields that changed since the tick before (bit i = i-th 32-bit word of Input; before the
// first tick every word is 0) and, for each, the varint of old bits XOR new bits; mask 0 is followed by the varint
// number of ticks on which nothing changed.
//
//   InputCode code;
//   code.add(input);                               // a tick each
//   const std::uint64_t count = code.count();
//   write(code.bytes(), code.count());
//   code.clear();                                  // the next tick begins from zeros
//   if (!append_inputs(bytes, count, inputs)) ...  // not that many, or no code at all
#pragma once

#include <trocar/core/byte_code.hpp>
#include <trocar/sim/model/input.hpp>

namespace trocar::sim {

class InputCode {
 public:
  InputCode();
  void reserve(std::uint64_t ticks);  ///< so many take no memory any more
  void add(const Input& input);
  std::uint64_t count() const { return m_count; }  ///< ticks
  core::ByteView bytes();                          ///< of all of them, until the next add() or clear()
  void clear();

 private:
  void end_run();
  core::ByteString m_bytes;
  std::uint64_t m_count = 0;
  std::uint64_t m_unchanged = 0;  ///< the last ticks, equal to the one before them and not yet coded
  Input m_last;
};

/// Appends `count` ticks; false (and `inputs` as it was) when the bytes do not hold exactly so many.
bool append_inputs(core::ByteView bytes, std::uint64_t count, std::vector<Input>& inputs);

}  // namespace trocar::sim
