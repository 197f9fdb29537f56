// Records that a verb leaves, one after another, in a State's buffer of fixed size.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

namespace trocar::sim {

/// @tparam Record  const for who only reads
template <class Record, class Count>
struct RecordBuffer {
  std::span<Record> records;  ///< all that there is room for
  Count& count;               ///< of them in use

  std::span<Record> used() const noexcept { return records.first(std::size_t(count)); }
};
template <class Records, class Count>
RecordBuffer(Records&, Count&) -> RecordBuffer<std::remove_reference_t<decltype(std::declval<Records&>()[0])>, Count>;

}  // namespace trocar::sim
