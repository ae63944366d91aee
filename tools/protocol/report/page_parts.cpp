// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/report/page_parts.hpp"

#include <fmt/format.h>

#include "onboard/report/page/html_text.hpp"
#include "onboard/report/page/report_style.hpp"
#include "tools/protocol/report/plot.hpp"

namespace cairn::protocol {
namespace {

namespace html = report::html;

constexpr const char* kPageStyle =
    ".note { color: var(--soft); font-size: 13px; margin: 10px 0 0; } .notes span { color: var(--soft); } "
    "figure img { max-width: 100%; }";

}  // namespace

std::string page_head(const std::string& window_title, const std::string& title, const std::string& lead) {
  return fmt::format(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>{}</title><style>{}{}{}</style></head><body><main>"
      "<header><h1>{}</h1><p>{}</p></header>",
      html::escape(window_title), html::kStyle, kPlotStyle, kPageStyle, html::escape(title), lead);
}

std::string page_end(const std::string& footer) {
  return fmt::format("<footer>{}</footer></main></body></html>\n", html::escape(footer));
}

std::string figure(const std::string& title, const std::string& inside) {
  return fmt::format("<figure><figcaption>{}</figcaption>{}</figure>", html::escape(title), inside);
}

std::string picture(const std::string& title, std::span<const std::byte> png) {
  return figure(
      title, fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", html::escape(title), html::base64(png)));
}

std::string charts_section(const std::string& title, const std::string& figures, const std::string& below) {
  return fmt::format("<section><h2>{}</h2><div class=\"charts\">{}</div>{}</section>", html::escape(title), figures,
                     below);
}

std::string claims_section(const std::string& title, const std::vector<Claim>& claims) {
  std::string items;
  for (const Claim& c : claims)
    items += fmt::format("<li class=\"{}\">{}<span>: {}</span></li>", c.holds ? "good" : "bad", html::escape(c.claim),
                         html::escape((c.holds ? "" : "not so here, ") + c.figures));
  if (items.empty()) return items;
  return fmt::format("<section><h2>{}</h2><ul class=\"notes\">{}</ul></section>", html::escape(title), items);
}

std::string to_text(const std::vector<Claim>& claims) {
  std::string text;
  for (const Claim& c : claims)
    text += fmt::format("{}{}: {}\n", c.holds ? "holds:        " : "does not hold: ", c.claim, c.figures);
  return text;
}

}  // namespace cairn::protocol
