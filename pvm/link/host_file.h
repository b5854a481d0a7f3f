// PVM's host files: which machines the virtual machine is to have.
//
// One host a line, the name first, then options key=value; # begins a comment line, & a host that is not to be started.
// A line of * gives options for all lines that follow.  Source: manual page pvmd3(1).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace rayshade {

// One line of it, with the options of the `*` line before in front of its own.
struct HostLine {
  std::string name;
  std::string options;  // "ep=/build sp=2000"
};
std::vector<HostLine> readHostFile(std::istream& in);

// What sp= says, relative to 1000; the last one counts, and what PVM would not take does not.
int speedOf(const HostLine& line);

}  // namespace rayshade
