// SPDX-License-Identifier: Apache-2.0
#include "tools/team/process.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace cairn::team_run {
namespace {

/// In the new process. Only what may be called between fork() and exec().
[[noreturn]] void become(const Command& command, pid_t parent, char* const* words, const sigset_t& heard) {
  constexpr int kCannot = 127;
  // The parent's handlers would take what is meant for the program.
  for (const int number : {SIGINT, SIGTERM}) (void)::signal(number, SIG_DFL);
  (void)::sigprocmask(SIG_SETMASK, &heard, nullptr);
  (void)::prctl(PR_SET_PDEATHSIG, command.orphaned);
  if (::getppid() != parent) ::_exit(kCannot);  // it died before it could be watched
  (void)::setpgid(0, 0);
  constexpr mode_t kMode = 0644;
  const int log = ::open(command.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, kMode);
  const bool ready = log >= 0 && ::dup2(log, STDOUT_FILENO) >= 0 && ::dup2(log, STDERR_FILENO) >= 0 &&
                     (command.network < 0 || ::setns(command.network, CLONE_NEWNET) == 0) &&
                     ::chdir(command.folder.c_str()) == 0;
  if (ready) ::execv(words[0], words);
  const char* why = ::strerrordesc_np(errno);
  for (const char* text : {static_cast<const char*>(words[0]), ": cannot be started: ", why, "\n"})
    (void)!::write(STDERR_FILENO, text, std::strlen(text));
  ::_exit(kCannot);
}

int code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

}  // namespace

Result<Process> Process::start(const Command& command) {
  std::vector<std::string> words = command.words;
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  sigset_t all, heard;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &heard);
  const pid_t parent = ::getpid(), id = ::fork();
  if (id == 0) become(command, parent, pointers.data(), heard);
  ::pthread_sigmask(SIG_SETMASK, &heard, nullptr);
  if (id < 0)
    return Error{Errc::kIo, "cannot start a process", command.words[0], {}, std::generic_category().message(errno)};
  return Process(id);
}

Process::Process(Process&& other) noexcept : id_(std::exchange(other.id_, 0)), code_(other.code_) {}

Process& Process::operator=(Process&& other) noexcept {
  kill();
  id_ = std::exchange(other.id_, 0);
  code_ = other.code_;
  return *this;
}

void Process::signal(int number) const {
  if (id_ > 0) ::kill(id_, number);
}

std::optional<int> Process::ended() {
  int status = 0;
  if (id_ > 0 && ::waitpid(id_, &status, WNOHANG) == id_) {
    id_ = 0;
    code_ = code_of(status);
  }
  return code_;
}

void Process::kill() {
  int status = 0;
  if (id_ <= 0) return;
  ::kill(id_, SIGKILL);
  while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
  id_ = 0;
  code_ = code_of(status);
}

}  // namespace cairn::team_run
