# rayshade-pvm
#
#   make              build the programs into bin/
#   make demo         install what is missing, render a picture over PVM, compare it with the sequential one
#   make check        install what is missing, build, run all tests
#   make install PREFIX=/usr/local        programs into PREFIX/bin, and where `pvm` looks by convention; their manual pages
#                     and completions for bash into PREFIX/share.  `make uninstall PREFIX=...` removes exactly that
#   make man          the manual pages alone, into bin/share/man (`make` writes them, too)
#   make check-sanitized   the tests of what reads bytes of others or juggles tasks, under clang's sanitizers for
#                     addresses and undefined behaviour; all tests: make SAN=address,undefined check
#   make check-threads     pictures of several threads under clang's sanitizer for threads
#   make check-processors  the same bits from other compilers, options and processors (an hour; arm64 under an emulator)
#   make docs         the generated parts of the documents (docs/generate); `make check` finds what is out of date
#   make fuzz         the fuzzers, FUZZ_SECONDS each, in the same build tree
#   make bench        docs/speed-and-error.md: measures error against time (a few minutes)
#   make benches      the other measuring programs into bin/bench/
#   make bench-embree bin/bench/embree_rate: rays per second beside Embree (Debian: libembree-dev)
#   make bench-splitting     what threads and tasks cost against one thread, with the goals; then start-up and memory
#   make calibrate    BUILD/costs: what a ray, a test, a message costs on this machine, for rayshade-simulate
#   make experiments  the schemes of the paper measured over PVM, into docs/experiments/ (7 minutes);
#                     QUICK=1: small pictures, into BUILD/experiments (2 minutes)
#   make prove-adding a new primitive in a copy of this tree: what it costs, and what is said when something is forgotten
#   make graph        draws which folder includes which: BUILD/graph.svg, .png, .dot; FOLDERS="rayshade pvm scenes tests": all
#
# CXX=, OPTIMIZE= and EXTRA_FLAGS= hold for all files; who changes them builds anew.  V=1 shows whole commands.
# As many jobs run as there are cores, unless -j says otherwise.
#
# Sources find themselves: a new file needs no edit here.  Every program is linked from one library of the same
# object files, so every program does the same arithmetic.  Only the PVM programs link libpvm3.

ifeq (,$(findstring -j,$(shell echo "$$MAKEFLAGS")))
MAKEFLAGS += -j$(shell nproc 2>/dev/null || echo 2)
endif
MAKEFLAGS += --no-print-directory

comma := ,
CXX ?= g++
BUILD ?= build$(if $(SAN),-$(subst $(comma),-,$(SAN)))
BIN ?= $(if $(SAN),$(BUILD)/bin,bin)
PREFIX ?= /usr/local
FUZZ_SECONDS ?= 60
CLANG ?= $(if $(findstring clang,$(CXX)),$(CXX),clang++)
# -ffp-contract=off: a fused multiply-add would give other bits on machines that have one.
# -Wno-psabi: wide vectors (rayshade/accel/simd.h) never leave the function that makes them.
# -Wno-maybe-uninitialized: g++ 12 sees uninitialised memory in std::regex and std::variant when it instruments them.
FLAGS := -std=c++20 $(or $(OPTIMIZE),-O2) -g1 -Wall -Wextra -Werror -Wno-psabi -ffp-contract=off -I. \
         $(if $(findstring clang,$(CXX)),-Wno-unknown-warning-option) $(if $(OPTIMIZE),-Wno-restrict) \
         $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer -Wno-maybe-uninitialized)
# What runs for long is worth a tenth more.  -Wno-restrict: g++ 12 then sees overlaps in std::string that are not there (its
# bug 105651).
long_running := $(if $(OPTIMIZE)$(SAN),,-O3 -Wno-restrict)
LIBRARIES := -lpng -ljpeg
# One tree serves tests and fuzzers; it is the one that clang compiles, too.  What is left out crashes anyway (null),
# does no harm here (alignment) or finds little; together they are a third of the time to compile.
sanitized := SAN=address,undefined OPTIMIZE=$(or $(OPTIMIZE),-O1) CXX="$(CLANG)" \
             EXTRA_FLAGS="$(EXTRA_FLAGS) -fsanitize=fuzzer-no-link -fno-sanitize=null,alignment,vptr,object-size"

objects = $(patsubst %.cc,$(BUILD)/%.o,$(1))
find_sources = $(sort $(shell find $(1) -name '*.cc'))

not_core := rayshade/program/main.cc rayshade/program/error_main.cc rayshade/program/events_main.cc rayshade/program/version.cc
core := $(call objects,$(filter-out $(not_core),$(call find_sources,rayshade)))
# The commit is known to this one object, which is compiled anew when it is another.
version := $(BUILD)/rayshade/program/version.o
commit := $(shell [ -e .git ] && git describe --always --dirty --abbrev=12 --exclude='*' 2>/dev/null)
spd := $(call objects,$(filter-out scenes/spd/main.cc,$(call find_sources,scenes/spd)))
pvm_door := $(call objects,$(filter-out pvm/link/host_file.cc,$(call find_sources,pvm/link)))
pvm_programs := $(call objects,$(addprefix pvm/program/,main.cc host_program.cc simulate_program.cc task_render.cc))
tasks := $(filter-out $(pvm_door) $(pvm_programs),$(call objects,$(call find_sources,pvm)))
oracle := $(call objects,$(call find_sources,tests/support/oracle))
support := $(filter-out $(oracle),$(call objects,$(call find_sources,tests/support)))
fuzzed := $(call objects,$(wildcard tests/fuzz/any_*.cc))
# Tests that need no PVM daemon make one program, those that do another one, and a third one plays several tasks itself.
pvm_tests := $(call objects,$(wildcard tests/parallel/pvm_*test.cc))
link_tests := $(call objects,$(wildcard tests/parallel/link_*test.cc))
tests := $(filter-out $(pvm_tests) $(link_tests),$(call objects,$(call find_sources,tests/unit tests/property tests/golden tests/parallel tests/fault)))
# What sanitizers are most likely to find fault with, because it reads bytes of others or juggles tasks, says so.
guarded_tests := $(call objects,$(sort $(shell grep -rl --include='*_test.cc' '^// guarded: ' tests)))
# What threads share, or what calls it: compiled once more, for the sanitizer of threads.
threaded := $(patsubst %.cc,$(BUILD)/threaded/%.o,rayshade/base/crew.cc $(call find_sources,rayshade/accel rayshade/intersect \
              rayshade/lights rayshade/sampling rayshade/shading rayshade/textures rayshade/trace))
fuzzers := $(patsubst tests/fuzz/%.cc,$(BIN)/%,$(wildcard tests/fuzz/*_fuzz.cc))
embree_bench := tests/bench/embree_rate.cc
benches := $(patsubst tests/bench/%.cc,$(BIN)/bench/%,$(filter-out $(embree_bench),$(call find_sources,tests/bench)))

roles := host voxel-trace pyramid-trace shade
programs := $(BIN)/rayshade $(BIN)/rayshade-error $(BIN)/rayshade-events $(BIN)/rayshade-simulate $(BIN)/spd $(roles:%=$(BIN)/rayshade-%)
# The programs write what is to be read about them.
documented := rayshade rayshade-error rayshade-events rayshade-host rayshade-simulate spd
pages := $(documented:%=$(BIN)/share/man/man1/%.1) $(patsubst %,$(BIN)/share/man/man1/rayshade-%.1,$(filter-out host,$(roles)))
completions := $(documented:%=$(BIN)/share/bash-completion/completions/%)
test_programs := $(BIN)/rayshade-tests $(BIN)/link-tests $(BIN)/pvm-tests

.PHONY: all man demo docs check check-sanitized check-threads check-processors build-tests test guarded install install-files uninstall fuzz fuzzers bench benches bench-splitting bench-embree calibrate experiments prove-adding graph format clean packages always
all: $(programs) $(pages) $(completions)
man: $(pages)

# One short line for a command, or with V=1 the command.
verbose := $(filter-out 0,$(V))
say = $(if $(verbose),,@echo "  $(1)")
quietly := $(if $(verbose),,@)

# What was built with other flags is built again, and what held files that are gone.
$(BUILD)/flags: now = $(strip $(filter-out ccache,$(CXX)) $(FLAGS) $(long_running) $(EXTRA_FLAGS))
$(BUILD)/sources: now = $(core) $(tasks) $(spd) $(support) $(oracle) $(tests) $(pvm_tests) $(link_tests) $(guarded_tests)
$(BUILD)/commit: now = $(commit)
$(BUILD)/flags $(BUILD)/sources $(BUILD)/commit: always
	@mkdir -p $(@D)
	@echo '$(subst ','\'',$(now))' | cmp -s - $@ || echo '$(subst ','\'',$(now))' >$@

$(core) $(tasks): private also := $(long_running)
# What nearly all tests begin with is read once.  By clang alone: g++ 12 then sees string overruns that are not there.
ifneq (,$(findstring clang,$(CXX)))
precompiled := $(BUILD)/tests/gtest.h
$(tests) $(pvm_tests) $(link_tests): private also := -include $(precompiled)
$(tests) $(pvm_tests) $(link_tests): | $(precompiled).pch
$(precompiled).pch: $(BUILD)/flags
	@mkdir -p $(@D)
	@echo '#include <gtest/gtest.h>' >$(precompiled)
	$(quietly)$(CXX) $(FLAGS) $(EXTRA_FLAGS) -x c++-header $(precompiled) -o $@
endif
$(version): private also := -DRAYSHADE_COMMIT='"$(commit)"'
$(version): $(BUILD)/commit
$(BUILD)/%.o: %.cc $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,compile $<)
	$(quietly)$(CXX) $(FLAGS) $(also) $(EXTRA_FLAGS) -MMD -MP -c $< -o $@

$(threaded): $(BUILD)/threaded/%.o: %.cc $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,compile $< for check-threads)
	$(quietly)$(CLANG) -std=c++20 -O1 -g1 -Wno-psabi -Wno-unknown-warning-option -ffp-contract=off -I. -fsanitize=thread -MMD -MP -c $< -o $@

$(BUILD)/libcore.a: $(core)
$(BUILD)/libtasks.a: $(tasks)
$(BUILD)/libspd.a: $(spd)
$(BUILD)/libsupport.a: $(support)
$(BUILD)/lib%.a: $(BUILD)/sources
	$(call say,collect $@)
	@rm -f $@
	$(quietly)$(AR) rcs $@ $(filter %.o,$^)

define link
@mkdir -p $(@D)
$(call say,link $@)
$(quietly)$(CXX) $(FLAGS) $(EXTRA_FLAGS) $(filter %.o,$^) $(filter %.a,$^) $(1) $(LIBRARIES) -o $@
endef
libraries := $(BUILD)/libtasks.a $(BUILD)/libspd.a $(BUILD)/libcore.a

$(BIN)/rayshade: $(BUILD)/rayshade/program/main.o $(version) $(BUILD)/libcore.a
	$(call link)
# The objects that are checked stand before the library that holds them, too.
$(BUILD)/threaded/program: $(BUILD)/rayshade/program/main.o $(version) $(threaded) $(BUILD)/libcore.a
	$(call say,link $@)
	$(quietly)$(CLANG) -fsanitize=thread $(filter %.o,$^) $(filter %.a,$^) $(LIBRARIES) -o $@
$(BIN)/rayshade-error: $(BUILD)/rayshade/program/error_main.o $(version) $(BUILD)/libcore.a
	$(call link)
$(BIN)/rayshade-events: $(BUILD)/rayshade/program/events_main.o $(version) $(BUILD)/libcore.a
	$(call link)
$(BIN)/spd: $(BUILD)/scenes/spd/main.o $(version) $(BUILD)/libspd.a $(BUILD)/libcore.a
	$(call link)
$(BIN)/rayshade-host: $(pvm_programs) $(version) $(pvm_door) $(BUILD)/libtasks.a $(BUILD)/libcore.a
	$(call link,-lpvm3)
# The role of a task is the name under which it was started: one program, several names.
$(BIN)/rayshade-simulate $(BIN)/rayshade-voxel-trace $(BIN)/rayshade-pyramid-trace $(BIN)/rayshade-shade: $(BIN)/rayshade-host
	$(call say,link $@)
	$(quietly)ln -f $< $@
$(BIN)/share/man/man1/%.1: $(BIN)/%
	@mkdir -p $(@D)
	$(quietly)$(if $(filter $*,$(documented)),$< --manual-page,echo .so man1/rayshade-host.1) >$@.part
	@mv $@.part $@
$(BIN)/share/bash-completion/completions/%: $(BIN)/%
	@mkdir -p $(@D)
	$(quietly)$< --completions >$@.part
	@mv $@.part $@
$(BIN)/rayshade-tests: $(tests) $(fuzzed) $(oracle) $(BUILD)/libsupport.a $(libraries)
	$(call link,-lgtest -lgtest_main -lpthread -lmpfr)
$(BIN)/guarded-tests: $(guarded_tests) $(fuzzed) $(BUILD)/libsupport.a $(libraries)
	$(call link,-lgtest -lgtest_main -lpthread)
$(BIN)/link-tests: $(link_tests) $(pvm_door) $(BUILD)/libsupport.a $(libraries)
	$(call link,-lgtest -lpthread -lpvm3)
$(BIN)/pvm-tests: $(pvm_tests) $(pvm_door) $(BUILD)/libsupport.a $(libraries)
	$(call link,-lgtest -lgtest_main -lpthread -lpvm3)
$(test_programs) $(BIN)/guarded-tests: $(BUILD)/sources
$(fuzzers): $(BIN)/%_fuzz: $(BUILD)/tests/fuzz/%_fuzz.o $(fuzzed) $(libraries)
	$(call link,-fsanitize=fuzzer)
$(BIN)/bench/oracle_fuzz: $(oracle)
$(BIN)/bench/%: $(BUILD)/tests/bench/%.o $(pvm_door) $(BUILD)/libsupport.a $(libraries)
	$(call link,-lbenchmark -lpthread -lpvm3)

packages:
	@tests/support/install_packages

demo: packages
	@$(MAKE) all
	@tests/support/demo $(BIN)

check: packages
	@$(MAKE) test
check-sanitized:
	@tests/support/install_packages nice
	@$(MAKE) $(sanitized) guarded
check-processors: all $(BIN)/rayshade-tests
	@tests/support/install_packages processors
	@tests/support/check_processors $(BUILD) $(BIN)
check-threads: $(BUILD)/threaded/program $(BIN)/rayshade
	@tests/support/check_threads $^
build-tests: all $(test_programs)
test: build-tests
	@tests/support/run_shards $(BIN) $(notdir $(test_programs))

# Sanitizers make tests eight times slower: fewer random scenes than without.
guarded: $(BIN)/guarded-tests
	@RAYSHADE_TEST_SEEDS=$${RAYSHADE_TEST_SEEDS:-20} tests/support/run_shards $(BIN) guarded-tests

benches: $(benches)
bench-embree: LIBRARIES += -lembree3
bench-embree: $(BIN)/bench/embree_rate

bench: $(BIN)/rayshade $(BIN)/rayshade-error $(BIN)/spd
	@PYTHONDONTWRITEBYTECODE=1 tests/bench/speed_and_error/run --bin $(BIN) docs

bench-splitting: all benches
	@tests/bench/plot_splitting
	@tests/bench/start_up || true
	@tests/bench/memory || true

calibrate: all
	@tests/bench/calibrate $(BUILD)/costs

experiments: all
	@PYTHONDONTWRITEBYTECODE=1 tests/bench/experiments/run $(BIN) $(if $(QUICK),$(BUILD)/experiments --quick,docs/experiments)

docs: all
	@docs/generate --bin $(BIN)

graph:
	@tests/support/install_packages graph
	@tests/support/draw_includes $(BUILD)/graph $(FOLDERS)

fuzz:
	@$(MAKE) $(sanitized) fuzzers
	@tests/support/fuzz build-address-undefined/bin $(FUZZ_SECONDS)
fuzzers: $(fuzzers)

install: all
	@$(MAKE) install-files
to := $(DESTDIR)$(abspath $(PREFIX))
shared := $(patsubst $(BIN)/%,%,$(pages) $(completions))
in_home := $(HOME)/pvm3/bin/LINUX64
install-files:
	@for file in $(notdir $(programs)); do install -D -m 755 $(BIN)/$$file $(to)/bin/$$file || exit; done
	@for file in $(shared); do install -D -m 644 $(BIN)/$$file $(to)/$$file || exit; done
	@if [ -z "$(DESTDIR)" ]; then install -d $(in_home) && \
	  for role in $(roles); do ln -sf $(to)/bin/rayshade-$$role $(in_home)/ || exit; done; fi
	@echo "  installed into $(to): bin, share/man, share/bash-completion"
uninstall:
	rm -f $(addprefix $(to)/bin/,$(notdir $(programs))) $(addprefix $(to)/,$(shared))
	@if [ -z "$(DESTDIR)" ]; then for role in $(roles); do \
	  [ "$$(readlink $(in_home)/rayshade-$$role)" != $(to)/bin/rayshade-$$role ] || rm -f $(in_home)/rayshade-$$role; done; fi

prove-adding: ; @tests/support/add_primitive
format:
	clang-format -i $(shell find rayshade pvm scenes tests -name '*.cc' -o -name '*.h')
clean:
	rm -rf build build-* bin

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
