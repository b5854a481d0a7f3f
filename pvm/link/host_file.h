// PVM's host files: which machines the virtual machine is to have.
//
// One host a line, the name first, then options key=value; # begins a comment line, & a host that is not to be started.
// A line of * gives options for all lines that follow.  Source: manual page pvmd3(1).
//
// A comment line of our own says how much memory our tasks may take there, in MB: `# rayshade memory=MB NAME...`; without
// names, on every host of the file that no such line names.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <vector>

namespace rayshade {

// One line of it, with the options of the `*` line before in front of its own.
struct HostLine {
  std::string name;
  std::string options;       // "ep=/build sp=2000"
  int speed = 1000;          // what sp= says; the last one counts
  std::uint64_t memory = 0;  // for our tasks, bytes; 0: nothing is said
};
// Throws MachineError, `file` being the name in messages: a speed that PVM would not take, memory of an unknown host.
std::vector<HostLine> readHostFile(std::istream& in, const std::string& file);

}  // namespace rayshade
