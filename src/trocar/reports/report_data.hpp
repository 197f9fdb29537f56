// What the page of a report says, as data: numbers as people read them, the rows of its tables, its drawings as SVG.
// How it stands on the page is pages/attempt.html's.
#pragma once

#include <trocar/reports/report.hpp>

namespace trocar::reports {

/// All that pages/attempt.html asks for; a part of which there is nothing to say is null.
Json page_data(const Report& report);

/// A member, or null where there is none.
const Json& part_of(const Json& object, const char* key);

}  // namespace trocar::reports
