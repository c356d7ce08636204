#include "engine/core/processors.h"

#include <sched.h>

#include <algorithm>

#include "tests/support/support.h"

namespace gfxrepro::test {
namespace {

/// As a process whose group below /sys/fs/cgroup is jobs/12 sees it, allowed on all processors.
struct UsableProcessors : FolderTest {
    UsableProcessors() { folder.write("proc/self/cgroup", "0::/jobs/12\n"); }
    void limit(const std::string& group, const std::string& max) const {
        folder.write("sys/fs/cgroup/" + group + "cpu.max", max);
    }
    int count() const { return usableProcessors(folder.path()); }

    int all = usableProcessors(TemporaryFolder().path());
};

TEST_F(UsableProcessors, WithoutALimitAllThatItMayRunOn) {
    EXPECT_GE(all, 1);
    EXPECT_EQ(count(), all);
    limit("jobs/12/", "max 100000\n");
    EXPECT_EQ(count(), all);
    limit("jobs/12/", "no number\n");
    EXPECT_EQ(count(), all);
}

TEST_F(UsableProcessors, TheSmallestQuotaOfItsGroupAndThoseAbove) {
    limit("jobs/12/", "50000 100000\n");
    EXPECT_EQ(count(), 1);
    limit("jobs/12/", "1600000 100000\n");
    EXPECT_EQ(count(), std::min(all, 16));
    limit("jobs/", "100000 100000\n");
    EXPECT_EQ(count(), 1);
    limit("jobs/", "max 100000\n");
    limit("", "100000 100000\n");  // a container sees its own group as the root
    EXPECT_EQ(count(), 1);
}

TEST_F(UsableProcessors, AlsoOfGroupsOfVersion1) {
    folder.write("proc/self/cgroup", "5:cpuset:/\n2:cpu,cpuacct:/jobs/12\n0::/\n");
    folder.write("sys/fs/cgroup/cpu/jobs/12/cpu.cfs_period_us", "100000\n");
    folder.write("sys/fs/cgroup/cpu/jobs/12/cpu.cfs_quota_us", "-1\n");
    EXPECT_EQ(count(), all);
    folder.write("sys/fs/cgroup/cpu/jobs/12/cpu.cfs_quota_us", "50000\n");
    EXPECT_EQ(count(), 1);
}

TEST_F(UsableProcessors, OnlyThoseOfItsMask) {
    cpu_set_t before;
    ASSERT_EQ(::sched_getaffinity(0, sizeof(before), &before), 0);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int i = 0; CPU_COUNT(&one) == 0; ++i) {
        if (CPU_ISSET(i, &before)) CPU_SET(i, &one);
    }
    ASSERT_EQ(::sched_setaffinity(0, sizeof(one), &one), 0);
    const int left = count();
    ::sched_setaffinity(0, sizeof(before), &before);
    EXPECT_EQ(left, 1);
}

}  // namespace
}  // namespace gfxrepro::test
