// Where PVM's daemon keeps its files, and what they tell: is there a virtual machine of this user?
//
// Nothing here calls libpvm, which waits 12 s on the address file of a daemon that has died.
// Source: manual pages pvmd3(1), pvm_intro(1PVM); pvm 3.4.6.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rayshade {

enum class MachineState {
  none,     // no address file
  alive,    // a daemon answers
  stale,    // a daemon has died and left its file; ours to remove
  foreign,  // the file or the daemon belongs to somebody else: this place is no use
};

// Takes milliseconds.
MachineState lookForMachine();

// libpvm leaves the names of the sockets at which direct routes were opened; takes away those of this process and of
// processes that have ended, where nobody listens.  Waits so many seconds for others to end.
void removeRouteSockets(double patience = 0);

// Removes the files of a daemon that is gone.  Only what is ours and is what it should be: the address file is not to be
// trusted with names of other files.
void removeLeftovers();

std::string environment(const char* name);  // "": not set
std::string pvmDirectory();                 // where the files are
std::string pvmFile(const char* kind);      // pvmd: where the daemon's socket is; pvml: its log
std::string socketPath();                   // of the daemon; "": not known
bool usableDirectory(const std::string& directory);

}  // namespace rayshade
