// A page on paper: HTML printed to PDF by the Chromium of this machine.
// Its bytes differ from print to print: a copy to read, and no result that `rerun` compares.
#pragma once
#include <string>

namespace servodx {

// Throws InputError where no browser is found: Debian's `chromium`, or what SERVODX_BROWSER names.
void require_browser();
void print_page(const std::string& html, const std::string& pdf);

}  // namespace servodx
