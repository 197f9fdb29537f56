// Makes the page of an attempt on a thread of its own (its pictures take seconds) and opens it in the browser.
//
//   ReportOpener reports;
//   reports.open(store, uuid_or_number);
//   if (std::string page = reports.poll(); !page.empty()) ...      // once per picture; it is written, the browser
//   started show(reports.say());
#pragma once

#include <future>
#include <string>

#include <trocar/training/store.hpp>

namespace trocar::app {

class ReportOpener {
 public:
  /// Nothing happens while another page is being made, or without a store.
  void open(const training::Store* store, const std::string& attempt);
  std::string poll();                               ///< the page's path when it has just been finished, else empty
  const std::string& say() const { return m_say; }  ///< "making the report ...", where it is, or why there is none

 private:
  std::future<std::string> m_page;
  std::string m_say;
};

}  // namespace trocar::app
