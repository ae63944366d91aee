// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/live_view.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace cairn::app {
namespace {

using LiveJson = nlohmann::ordered_json;

// Deeper than any view; nlohmann's parser is iterative, but its values are taken apart again.
constexpr int kMaxDepth = 4;

/// Ends after a word where there is one.
std::string clipped(std::string_view text) {
  constexpr std::string_view kMore = "...";
  text = text.substr(0, LiveView::kMaxText - kMore.size());
  // Not in the middle of a character.
  while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) text.remove_suffix(1);
  if (!text.empty() && static_cast<unsigned char>(text.back()) >= 0xC0U) text.remove_suffix(1);
  if (const std::size_t space = text.rfind(' '); space != std::string_view::npos && space > LiveView::kMaxText / 2)
    text = text.substr(0, space);
  return std::string(text).append(kMore);
}
std::string short_text(const std::string& text) { return text.size() > LiveView::kMaxText ? clipped(text) : text; }

LiveJson to_json(const LiveView::Stage& s) {
  return {{"name", short_text(s.name)}, {"p50_ms", s.p50_ms},    {"p99_ms", s.p99_ms},
          {"p999_ms", s.p999_ms},       {"max_ms", s.max_ms},    {"deadline_ms", s.deadline_ms},
          {"budget_ms", s.budget_ms},   {"count", s.count},      {"overruns", s.overruns},
          {"slips", s.slips},           {"misses", s.misses},    {"dropped", s.dropped},
          {"queued", s.queued},         {"capacity", s.capacity}};
}
LiveJson to_json(const LiveView::Event& e) {
  return {{"t_s", e.t_s}, {"stage", short_text(e.stage)}, {"what", short_text(e.what)}, {"count", e.count}};
}

LiveJson to_json(const LiveView::Peer& p) {
  return {{"name", short_text(p.name)},
          {"merged", p.merged},
          {"state", short_text(p.state)},
          {"reason", short_text(p.reason)},
          {"heard_s_ago", p.heard_s_ago},
          {"tiles", p.tiles},
          {"tx_bytes", p.tx_bytes},
          {"rx_bytes", p.rx_bytes},
          {"clock_offset_s", p.clock_offset_s},
          {"deployment_contradicted", p.deployment_contradicted}};
}

LiveJson to_json(const std::optional<LiveView::People>& p) {
  if (!p) return nullptr;
  return {{"now", p->now}, {"tracks", p->tracks}, {"nearest_m", p->nearest_m}};
}

template <class T, class Make>
LiveJson list(const std::vector<T>& items, std::size_t skip, Make make) {
  LiveJson out = LiveJson::array();
  for (std::size_t i = skip; i < items.size() && out.size() < LiveView::kMaxItems; ++i) out.push_back(make(items[i]));
  return out;
}

std::string line_without(const LiveView& v, std::size_t events_left_out) {
  const LiveJson json{{"robot", short_text(v.robot)},
                      {"t_s", v.t_s},
                      {"mode", short_text(v.mode)},
                      {"cause", short_text(v.cause)},
                      {"shed", short_text(v.shed)},
                      {"epoch", v.epoch},
                      {"scans", v.scans},
                      {"rss_mb", v.rss_mb},
                      {"faults", list(v.faults, 0, short_text)},
                      {"stages", list(v.stages, 0, [](const auto& s) { return to_json(s); })},
                      {"events", list(v.events, events_left_out, [](const auto& e) { return to_json(e); })},
                      {"peers", list(v.peers, 0, [](const auto& p) { return to_json(p); })},
                      {"people", to_json(v.people)}};
  return json.dump(-1, ' ', false, LiveJson::error_handler_t::replace) + "\n";
}

/// Reads the members of one object; what is not as expected keeps its default.
class Members {
 public:
  explicit Members(const LiveJson& json) : json_(json) {}

  void read(const char* key, std::string& value) const {
    if (const LiveJson* found = find(key); found != nullptr && found->is_string())
      value = short_text(found->get_ref<const std::string&>());
  }
  void read(const char* key, double& value) const {
    const LiveJson* found = find(key);
    if (found != nullptr && found->is_number() && std::isfinite(found->get<double>())) value = found->get<double>();
  }
  void read(const char* key, bool& value) const {
    if (const LiveJson* found = find(key); found != nullptr && found->is_boolean()) value = found->get<bool>();
  }
  template <class Integer>
  void read(const char* key, Integer& value) const {
    const LiveJson* found = find(key);
    if (found != nullptr && found->is_number_unsigned()) value = static_cast<Integer>(found->get<std::uint64_t>());
  }
  template <class T, class Make>
  void read_object(const char* key, std::optional<T>& value, Make make) const {
    const LiveJson* found = find(key);
    if (found != nullptr && found->is_object()) make(*found, value.emplace());
  }
  template <class T, class Make>
  void read_list(const char* key, std::vector<T>& items, Make make) const {
    const LiveJson* found = find(key);
    if (found == nullptr || !found->is_array()) return;
    for (const LiveJson& item : *found) {
      if (items.size() >= LiveView::kMaxItems) return;
      make(item, items.emplace_back());
    }
  }

 private:
  [[nodiscard]] const LiveJson* find(const char* key) const {
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  const LiveJson& json_;
};

void read_stage(const LiveJson& json, LiveView::Stage& s) {
  if (!json.is_object()) return;
  const Members in(json);
  in.read("name", s.name);
  in.read("p50_ms", s.p50_ms);
  in.read("p99_ms", s.p99_ms);
  in.read("p999_ms", s.p999_ms);
  in.read("max_ms", s.max_ms);
  in.read("deadline_ms", s.deadline_ms);
  in.read("budget_ms", s.budget_ms);
  in.read("count", s.count);
  in.read("overruns", s.overruns);
  in.read("slips", s.slips);
  in.read("misses", s.misses);
  in.read("dropped", s.dropped);
  in.read("queued", s.queued);
  in.read("capacity", s.capacity);
}

void read_event(const LiveJson& json, LiveView::Event& e) {
  if (!json.is_object()) return;
  const Members in(json);
  in.read("t_s", e.t_s);
  in.read("stage", e.stage);
  in.read("what", e.what);
  in.read("count", e.count);
}

void read_peer(const LiveJson& json, LiveView::Peer& p) {
  if (!json.is_object()) return;
  const Members in(json);
  in.read("name", p.name);
  in.read("merged", p.merged);
  in.read("state", p.state);
  in.read("reason", p.reason);
  in.read("heard_s_ago", p.heard_s_ago);
  in.read("tiles", p.tiles);
  in.read("tx_bytes", p.tx_bytes);
  in.read("rx_bytes", p.rx_bytes);
  in.read("clock_offset_s", p.clock_offset_s);
  in.read("deployment_contradicted", p.deployment_contradicted);
}

void read_people(const LiveJson& json, LiveView::People& p) {
  const Members in(json);
  in.read("now", p.now);
  in.read("tracks", p.tracks);
  in.read("nearest_m", p.nearest_m);
}

}  // namespace

std::string to_line(const LiveView& view) {
  std::size_t skip = view.events.size() > LiveView::kMaxItems ? view.events.size() - LiveView::kMaxItems : 0;
  std::string line = line_without(view, skip);
  while (line.size() > LiveView::kMaxLine && skip < view.events.size()) {
    skip += 8;
    line = line_without(view, skip);
  }
  return line;
}

Result<LiveView> parse_line(std::string_view line) {
  if (line.size() > LiveView::kMaxLine) return Error{Errc::kLimit, "a line of the live view is too long"};
  const auto shallow = [](int depth, LiveJson::parse_event_t, LiveJson&) { return depth <= kMaxDepth; };
  const LiveJson json = LiveJson::parse(line.begin(), line.end(), shallow, false);
  if (json.is_discarded() || !json.is_object())
    return Error{Errc::kMalformed, "a line of the live view is no JSON object"};
  LiveView v;
  const Members in(json);
  in.read("robot", v.robot);
  in.read("t_s", v.t_s);
  in.read("mode", v.mode);
  in.read("cause", v.cause);
  in.read("shed", v.shed);
  in.read("epoch", v.epoch);
  in.read("scans", v.scans);
  in.read("rss_mb", v.rss_mb);
  in.read_list("faults", v.faults, [](const LiveJson& item, std::string& text) {
    if (item.is_string()) text = short_text(item.get_ref<const std::string&>());
  });
  in.read_list("stages", v.stages, read_stage);
  in.read_list("events", v.events, read_event);
  in.read_list("peers", v.peers, read_peer);
  in.read_object("people", v.people, read_people);
  return v;
}

}  // namespace cairn::app
