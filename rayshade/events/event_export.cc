// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/events/event_export.h"

#include <cinttypes>
#include <limits>
#include <map>
#include <tuple>

namespace rayshade {
namespace {

// Names and times as all exports have them.
class Reading {
 public:
  explicit Reading(const EventFile& file) : file_(file) {
    for (const EventLane& lane : file.lanes) {
      names_[lane.task] = lane.name();
      for (const Event& event : lane.log.events) origin_ = std::min(origin_, shifted(lane, event.begin));
    }
  }
  // Nanoseconds since the first event of all.
  std::int64_t at(const EventLane& lane, std::uint64_t time) const { return shifted(lane, time) - origin_; }
  std::string nameOf(std::int32_t task) const {
    const auto found = names_.find(task);
    return found == names_.end() ? "task " + std::to_string(task) : found->second;
  }
  std::string messageOf(std::uint32_t tag) const {
    return tag < file_.messages.size() ? file_.messages[tag] : std::to_string(tag);
  }

 private:
  static std::int64_t shifted(const EventLane& lane, std::uint64_t time) {
    return static_cast<std::int64_t>(time) + lane.clock;
  }
  const EventFile& file_;
  std::map<std::int32_t, std::string> names_;
  std::int64_t origin_ = std::numeric_limits<std::int64_t>::max();
};

bool isInstant(EventKind kind) { return kind >= EventKind::given || kind == EventKind::content; }

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out + "\"";
}

// The numbers that an event of this kind has: use(name, value).
template <class Use>
void forNumbers(const Event& event, const Reading& reading, Use use) {
  const EventKindNames& names = namesOf(event.kind);
  if (names.peer[0] != 0) use(names.peer, quoted(reading.nameOf(event.peer)));
  if (names.number[0] != 0)
    use(names.number, event.kind == EventKind::content ? quoted(reading.messageOf(event.number))
                                                       : std::to_string(event.number));
  if (names.count[0] != 0) use(names.count, std::to_string(event.count));
  if (names.amount[0] != 0) use(names.amount, std::to_string(event.amount));
}

// The packet of an encode or decode: sender, receiver, its number among theirs.
std::string packetOf(const EventLane& lane, const Event& event) {
  const bool goes = event.kind == EventKind::encode;
  return std::to_string(goes ? lane.task : event.peer) + ">" + std::to_string(goes ? event.peer : lane.task) +
         "." + std::to_string(event.number);
}

}  // namespace

// Totals first: they hold when events were dropped, too.
void writeTsv(std::FILE* to, const EventFile& file) {
  const Reading reading(file);
  for (const EventLane& lane : file.lanes) {
    std::fprintf(to, "# %s\tmachine %s\ttask %d\tdropped %" PRIu64 "\n", lane.name().c_str(),
                 lane.machine.c_str(), lane.task, lane.log.dropped);
    for (std::size_t kind = 0; kind < kEventKindCount; ++kind) {
      const EventTotal& total = lane.log.totals[kind];
      if (total.events > 0)
        std::fprintf(to, "# total\t%s\t%s\t%" PRIu64 "\t%.9f\t%" PRIu64 "\t%" PRIu64 "\n",
                     lane.name().c_str(), kEventKinds[kind].name, total.events,
                     1e-9 * static_cast<double>(total.nanoseconds), total.count, total.amount);
    }
  }
  std::fprintf(to, "task\tthread\tkind\tbegin\tend\tnumbers\n");
  for (const EventLane& lane : file.lanes)
    for (const Event& event : lane.log.events) {
      std::fprintf(to, "%s\t%u\t%s\t%.9f\t%.9f", lane.name().c_str(), event.thread, namesOf(event.kind).name,
                   1e-9 * static_cast<double>(reading.at(lane, event.begin)),
                   1e-9 * static_cast<double>(reading.at(lane, event.end)));
      forNumbers(event, reading, [to](const char* name, const std::string& value) {
        std::fprintf(to, "\t%s=%s", name, value.c_str());
      });
      std::fputc('\n', to);
    }
}

void writePerfetto(std::FILE* to, const EventFile& file) {
  const Reading reading(file);
  std::fprintf(to, "{\"traceEvents\":[\n");
  const char* between = "";
  for (std::size_t i = 0; i < file.lanes.size(); ++i) {
    const EventLane& lane = file.lanes[i];
    std::fprintf(to, "%s{\"ph\":\"M\",\"pid\":%zu,\"name\":\"process_name\",\"args\":{\"name\":%s}}", between,
                 i, quoted(lane.name() + " on " + lane.machine).c_str());
    between = ",\n";
    for (const Event& event : lane.log.events) {
      const double begin = 1e-3 * static_cast<double>(reading.at(lane, event.begin)),
                   span = 1e-3 * static_cast<double>(event.end - event.begin);
      const char* const name = namesOf(event.kind).name;
      const char* const phase = event.kind == EventKind::queue ? "C" : isInstant(event.kind) ? "i" : "X";
      std::fprintf(to, ",\n{\"ph\":\"%s\",\"pid\":%zu,\"tid\":%u,\"name\":\"%s\",\"ts\":%.3f", phase, i,
                   event.thread, name, begin);
      if (phase[0] == 'X') std::fprintf(to, ",\"dur\":%.3f", span);
      if (phase[0] == 'i') std::fprintf(to, ",\"s\":\"t\"");
      std::fprintf(to, ",\"args\":{");
      const char* comma = "";
      forNumbers(event, reading, [&](const char* label, const std::string& value) {
        std::fprintf(to, "%s\"%s\":%s", comma, label, value.c_str());
        comma = ",";
      });
      std::fprintf(to, "}}");
      if (event.kind == EventKind::encode || event.kind == EventKind::decode)
        std::fprintf(to,
                     ",\n{\"ph\":\"%s\",\"pid\":%zu,\"tid\":%u,\"cat\":\"packet\",\"name\":\"packet\",\"id\":"
                     "\"%s\",\"ts\":%.3f}",
                     event.kind == EventKind::encode ? "s" : "f\",\"bp\":\"e", i, event.thread,
                     packetOf(lane, event).c_str(), begin);
    }
  }
  std::fprintf(to, "\n]}\n");
}

namespace {

constexpr const char* kPajeHead =
    "%EventDef PajeDefineContainerType 0\n% Alias string\n% Type string\n% Name string\n%EndEventDef\n"
    "%EventDef PajeDefineStateType 1\n% Alias string\n% Type string\n% Name string\n%EndEventDef\n"
    "%EventDef PajeDefineVariableType 2\n% Alias string\n% Type string\n% Name string\n% Color "
    "color\n%EndEventDef\n"
    "%EventDef PajeDefineLinkType 3\n% Alias string\n% Type string\n% StartContainerType string\n% "
    "EndContainerType "
    "string\n% Name string\n%EndEventDef\n"
    "%EventDef PajeCreateContainer 4\n% Time date\n% Alias string\n% Type string\n% Container string\n% Name "
    "string\n%EndEventDef\n"
    "%EventDef PajePushState 5\n% Time date\n% Type string\n% Container string\n% Value "
    "string\n%EndEventDef\n"
    "%EventDef PajePopState 6\n% Time date\n% Type string\n% Container string\n%EndEventDef\n"
    "%EventDef PajeSetVariable 7\n% Time date\n% Type string\n% Container string\n% Value "
    "double\n%EndEventDef\n"
    "%EventDef PajeStartLink 8\n% Time date\n% Type string\n% Container string\n% StartContainer string\n% "
    "Value "
    "string\n% Key string\n%EndEventDef\n"
    "%EventDef PajeEndLink 9\n% Time date\n% Type string\n% Container string\n% EndContainer string\n% Value "
    "string\n% Key string\n%EndEventDef\n"
    "0 All 0 All\n0 Lane All Lane\n1 Does Lane Does\n2 Waits Lane Waits \"0.5 0.5 0.5\"\n3 Packet All Lane "
    "Lane Packet\n"
    "4 0.000000000 all All 0 all\n";

struct PajeLine {
  std::int64_t time;
  int rank;            // at the same time: what ends, longest inside first, before what begins
  std::int64_t order;  // of one rank
  std::string text;
};

}  // namespace

void writePaje(std::FILE* to, const EventFile& file) {
  const Reading reading(file);
  std::fputs(kPajeHead, to);
  std::vector<PajeLine> lines;
  for (std::size_t i = 0; i < file.lanes.size(); ++i) {
    const EventLane& lane = file.lanes[i];
    std::uint16_t threads = 0;
    const auto alias = [i](std::uint16_t thread) {
      return "L" + std::to_string(i) + "." + std::to_string(thread);
    };
    for (const Event& event : lane.log.events) threads = std::max(threads, event.thread);
    for (std::uint16_t thread = 0; thread <= threads; ++thread)
      std::fprintf(to, "4 0.000000000 %s Lane all %s\n", alias(thread).c_str(),
                   quoted(lane.name() + (thread > 0 ? "." + std::to_string(thread) : "")).c_str());
    for (const Event& event : lane.log.events) {
      const std::int64_t begin = reading.at(lane, event.begin), end = reading.at(lane, event.end);
      const std::string where = alias(event.thread);
      if (event.kind == EventKind::queue)
        lines.push_back({begin, 2, 0, " Waits " + where + " " + std::to_string(event.count)});
      if (isInstant(event.kind)) continue;
      if (end > begin) {
        lines.push_back({begin, 1, -end, " Does " + where + " " + namesOf(event.kind).name});
        lines.push_back({end, 0, -begin, " Does " + where});
      }
      const std::string key =
          event.kind == EventKind::encode || event.kind == EventKind::decode ? packetOf(lane, event) : "";
      if (!key.empty())
        lines.push_back(
            {begin, 3, event.kind == EventKind::decode, " Packet all " + where + " packet " + key});
    }
  }
  std::stable_sort(lines.begin(), lines.end(), [](const PajeLine& a, const PajeLine& b) {
    return std::tie(a.time, a.rank, a.order) < std::tie(b.time, b.rank, b.order);
  });
  constexpr const char* kCode[] = {"6", "5", "7"};
  for (const PajeLine& line : lines)
    std::fprintf(to, "%s %.9f%s\n",
                 line.rank < 3     ? kCode[line.rank]
                 : line.order == 0 ? "8"
                                   : "9",
                 1e-9 * static_cast<double>(line.time), line.text.c_str());
}

}  // namespace rayshade
