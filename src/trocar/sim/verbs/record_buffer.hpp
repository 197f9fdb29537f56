// What a verb leaves, one record after another: a State has room for so many.
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
