#include "corpus/campaigns/disposition.h"

#include <signal.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "corpus/campaigns/process.h"

namespace tetproof {
namespace {

// Programs report on either stream; standard error comes first.
std::string last_words(const Outcome& outcome) {
  const std::string words = last_line(outcome.stderr_tail);
  return words.empty() ? last_line(outcome.stdout_tail) : words;
}

std::string with_words(std::string text, const Outcome& outcome) {
  const std::string words = last_words(outcome);
  if (!words.empty()) text += ": " + words;
  return text;
}

bool says_out_of_memory(const Outcome& outcome) {
  std::string text = outcome.stderr_tail + outcome.stdout_tail;
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* words : {"bad_alloc", "out of memory", "cannot allocate memory"}) {
    if (text.find(words) != std::string::npos) return true;
  }
  return false;
}

Judgement judge_exit(const Outcome& outcome, ExitCodes codes) {
  const int code = outcome.exit_code;
  if (code == 0) return {Disposition::ok, "", true};
  if (says_out_of_memory(outcome)) {
    return {Disposition::out_of_memory, with_words("exit " + std::to_string(code), outcome)};
  }
  if (codes == ExitCodes::ours) {
    if (code == 1) return {Disposition::wrong_result, last_words(outcome), true};
    if (code == 5) return {Disposition::timeout, with_words("own limit", outcome)};
    if (code == 6) return {Disposition::crash, with_words("internal error", outcome)};
    if (code == 3 || code == 4) return {Disposition::rejected, last_words(outcome)};
  }
  if (codes == ExitCodes::unknown) {
    // A script that runs the program ends with 128 and the signal that ended it.
    if (code == 128 + SIGXCPU) return {Disposition::timeout, "processor limit"};
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) {
      if (code == 128 + signal)
        return {Disposition::crash, with_words(signal_name(signal), outcome)};
    }
  }
  return {Disposition::rejected, with_words("exit " + std::to_string(code), outcome)};
}

Judgement judge_signal(const Outcome& outcome) {
  const std::string name = signal_name(outcome.signal);
  if (outcome.signal == SIGKILL || outcome.signal == SIGTERM || outcome.signal == SIGINT ||
      outcome.signal == SIGHUP) {
    return {Disposition::killed, name + " from outside"};
  }
  const auto kind = says_out_of_memory(outcome) ? Disposition::out_of_memory : Disposition::crash;
  return {kind, with_words(name, outcome)};
}

}  // namespace

std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return "";
  const auto before = text.find_last_of("\r\n", end);
  const auto start = before == std::string::npos ? 0 : before + 1;
  return text.substr(start, end + 1 - start);
}

Judgement judge(const Outcome& outcome, ExitCodes codes) {
  switch (outcome.ending) {
    case Ending::exited:
      return judge_exit(outcome, codes);
    case Ending::signalled:
      return judge_signal(outcome);
    case Ending::wall_limit:
      return {Disposition::timeout, "wall limit"};
    case Ending::cpu_limit:
      return {Disposition::timeout, "processor limit"};
    case Ending::memory_limit:
      return {Disposition::out_of_memory, "memory limit"};
    case Ending::stopped:
      return {Disposition::killed, "stopped"};
    case Ending::not_started:
      return {Disposition::killed, "not started: " + outcome.error};
    case Ending::lost:
      break;
  }
  return {Disposition::killed, "the supervisor was killed"};
}

}  // namespace tetproof
