// A page on paper: HTML printed to PDF by the Chromium of this machine.
//
// The bytes are the same for the same page and browser: the two times that a browser writes into a PDF are set to the
// epoch.
#pragma once
#include <string>

namespace servodx {

// Throws InputError where no browser is found: Debian's `chromium`, or what SERVODX_BROWSER names.
void require_browser();
void print_page(const std::string& html, const std::string& pdf);

}  // namespace servodx
