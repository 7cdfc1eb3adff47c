// A report as one HTML page that stands alone: no scripts, nothing from elsewhere, printable, on light and
// dark ground. Also well-formed XML but for its first line.
#pragma once

#include "app/report/contents.hpp"

namespace flyball {

std::string report_page(const ReportContents& contents);

} // namespace flyball
