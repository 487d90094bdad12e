#pragma once

#include <string_view>

namespace sidestep::bench {

// The files of a report's page, those of bench/report/web/ as they are.
extern const std::string_view kReportPageHtml, kReportCss, kReportJs;

}  // namespace sidestep::bench
