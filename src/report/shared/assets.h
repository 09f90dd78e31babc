// Text files embedded at build (CMakeLists: servodx_embed): uPlot, and the style and script of src/report/shared/web/.
#pragma once
#include <string_view>

namespace servodx::report::assets {

extern const std::string_view chart_script, chart_style, page_script, page_style, field_list;

}  // namespace servodx::report::assets
