// What gzip or zlib packed, bounded by what the reader knows that it wants. Used by the readers only.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::geometry {

enum class Wrapping : unsigned char { gzip, zlib, none };

/// Bytes `from` up to `from + count` of what was packed; what comes before is unpacked and dropped. Files of several
/// members, as parallel packers write them, are one. No more memory is asked for than the packed bytes can fill.
/// @param at_most   fewer bytes will do; else they are a fault, as damaged ones are
/// @param progress  called with the share that is done; may throw
/// @param more      out: are there bytes behind these?
/// @throws core::BadInput  named `file`
std::vector<char> inflated(std::string_view packed, Wrapping wrapping, std::size_t from, std::size_t count,
                           const std::string& file, bool at_most = false,
                           const std::function<void(double)>& progress = {}, bool* more = nullptr);

std::string gzipped(std::string_view bytes);

}  // namespace trocar::geometry
