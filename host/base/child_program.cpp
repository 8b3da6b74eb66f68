#include "pillarfield/child_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kLongestLine = 400;

/// Standard streams of the program.
class FileActions {
 public:
  FileActions(int input, int output, int errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    if (output == ChildProgram::kDiscard) {
      posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    } else {
      posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    }
    posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
  }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

int wait_for_end(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Returns what posix_spawnp() does: 0 or an errno.
int spawn(const std::vector<std::string>& words, const FileActions& actions, pid_t& process) {
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  arguments.reserve(copies.size() + 1);
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return posix_spawnp(&process, arguments[0], actions.get(), nullptr, arguments.data(), environ);
}

}  // namespace

ChildProgram::ChildProgram(const std::vector<std::string>& words, const std::string& mend,
                           int output)
    : errors_(std::tmpfile()) {
  // Writing to a socket without a reader need not raise a signal; writing to a pipe does.
  std::array<int, 2> ends{};
  if (!errors_ || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw Error(words.front(), std::string("cannot be started: ") + std::strerror(errno),
                "free memory, files and temporary space");
  }
  fcntl(fileno(errors_.get()), F_SETFD, FD_CLOEXEC);
  input_ = ends[0];
  const FileActions actions(ends[1], output == kPipe ? ends[1] : output, fileno(errors_.get()));
  const int failure = spawn(words, actions, process_);
  close(ends[1]);
  if (failure == 0) return;
  close_input();
  if (failure == ENOENT) throw Error(words.front(), "is not installed", mend);
  throw Error(words.front(), std::string("cannot be started: ") + std::strerror(failure), mend);
}

ChildProgram::~ChildProgram() {
  close_input();
  if (process_ < 0) return;
  kill(process_, SIGKILL);
  wait_for_end(process_);
}

void ChildProgram::close_input() {
  if (input_ >= 0) close(input_);
  input_ = -1;
}

bool ChildProgram::feed(std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t taken = send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (taken < 0 && errno == EINTR) continue;
    if (taken < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(taken));
  }
  return true;
}

std::string ChildProgram::read_line() const {
  std::string line;
  char character = 0;
  while (recv(input_, &character, 1, 0) == 1 && character != '\n') line += character;
  return line;
}

bool ChildProgram::finish() {
  close_input();
  const int status = wait_for_end(process_);
  process_ = -1;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string ChildProgram::errors() const {
  std::string text;
  std::array<char, 4096> block{};
  std::rewind(errors_.get());
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), errors_.get())) {
    text.append(block.data(), count);
  }
  return text;
}

std::string ChildProgram::error_line() const {
  std::string text = errors();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (text.size() > kLongestLine) {
    text = "... " + text.substr(text.size() - kLongestLine);
  }
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    text.replace(end, 1, "; ");
  }
  return text.empty() ? "it gives no reason" : text;
}

}  // namespace pillarfield
