// The places of the slave tasks: they stay what they are, whatever hosts come and go.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/roster.h"

#include <gtest/gtest.h>

namespace rayshade {
namespace {

class HostsOnly final : public Machine {
 public:
  TaskId self() const override { return TaskId{1}; }
  TaskId parent() const override { return kNobody; }
  void send(TaskId, std::span<const std::byte>) override {}
  std::optional<LinkEvent> poll() override { return std::nullopt; }
  std::optional<LinkEvent> wait(double) override { return std::nullopt; }
  void watch(TaskId) override {}
  double now() const override { return 0; }
  Usage usage() const override { return {}; }
  unsigned cores() const override { return 1; }
  void useThreads(unsigned) override {}
  void run(Job) override {}
  std::vector<HostInfo> hosts() override { return ++asked, there; }
  Spawned spawn(Role role, const std::string&) override {
    started.push_back(role);
    return {TaskId{next_++}, ""};
  }
  void kill(TaskId) override {}

  std::vector<HostInfo> there{{"a"}, {"b"}, {"c"}};
  int asked = 0;
  std::vector<Role> started;

 private:
  std::int32_t next_ = 2;
};

TEST(Roster, SuccessorsHaveTheRolesOfTheDeadWhenAHostGoes) {
  HostsOnly machine;
  const HostOptions options;  // the number of tasks follows from that of the hosts
  Roster roster(machine, options);
  roster.startMissing();
  ASSERT_TRUE(roster.complete());
  std::vector<Placement> before;
  for (const Slave& slave : roster.slaves()) before.push_back(slave.placement);

  machine.there.pop_back();
  machine.started.clear();
  roster.buryHost("c");
  ASSERT_FALSE(roster.complete());
  roster.startMissing();
  ASSERT_TRUE(roster.complete());
  ASSERT_EQ(roster.slaves().size(), before.size());
  std::vector<Role> dead;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Placement& now = roster.slaves()[i].placement;
    EXPECT_EQ(now.role, before[i].role) << i;
    EXPECT_EQ(now.index, before[i].index) << i;
    EXPECT_NE(now.host, "c") << i;
    if (before[i].host == "c") dead.push_back(before[i].role);
  }
  EXPECT_EQ(machine.started, dead);
}

TEST(Roster, HostsAreAskedForOnceForAllTasksThatAreStarted) {
  HostsOnly machine;
  HostOptions options;
  options.wishes.voxels = 100;
  Roster roster(machine, options);
  roster.startMissing();
  roster.startMissing();
  EXPECT_EQ(machine.asked, 2);
}

TEST(Roster, WithoutHostsThereIsAMessage) {
  HostsOnly machine;
  const HostOptions options;
  Roster roster(machine, options);
  machine.there.clear();
  EXPECT_THROW(roster.startMissing(), HostError);
  EXPECT_THROW(Roster(machine, options), HostError);
}

}  // namespace
}  // namespace rayshade
