// Documents compiled beside the window: the newest that was asked for, one at a time.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <vector>

#include <trocar/modeller/drive/built.hpp>

namespace trocar::app {

/// What came of a document: its model, and what is told of it.
struct BuiltDocument {
  modeller::Built built;
  std::vector<modeller::ReadOut> read_outs;
};

class Builder {
 public:
  /// Asks for the document as it is now; cheap where it is under way or made already.
  void want(const modeller::Document& document);
  /// Something new is there; null: not yet.
  std::unique_ptr<BuiltDocument> poll();
  /// Another document: what was asked for the one before is not wanted any more.
  void forget();
  bool busy() const { return m_running.valid(); }

 private:
  std::future<std::unique_ptr<BuiltDocument>> m_running;
  std::optional<modeller::Document> m_next;
  std::uint64_t m_asked = ~0ull;
  bool m_unwanted = false;  ///< what runs
};

}  // namespace trocar::app
