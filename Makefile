# rayshade-pvm
#
#   make              build the programs into bin/
#   make demo         install what is missing, render a picture over PVM, compare it with the sequential one
#   make check        install what is missing, build, run all tests
#   make install PREFIX=/usr/local        programs into PREFIX/bin, and where `pvm` looks by convention
#   make check-sanitized   the tests of what reads bytes of others or juggles tasks, under clang's sanitizers for
#                     addresses and undefined behaviour; all tests: make SAN=address,undefined check
#   make fuzz         the fuzzers, FUZZ_SECONDS each, in the same build tree
#   make bench        docs/speed-and-error.md: measures error against time (a few minutes)
#   make benches      the other measuring programs into bin/bench/
#   make bench-embree bin/bench/embree_rate: rays per second beside Embree (Debian: libembree-dev)
#   make experiments  the schemes of the paper measured over PVM, into docs/experiments/ (20 minutes);
#                     QUICK=1: small pictures, into BUILD/experiments (2 minutes)
#
# Sources find themselves: a new file needs no edit here.  Every program is linked from one library of the same
# object files, so every program does the same arithmetic.  Only the PVM programs link libpvm3.

comma := ,
CXX ?= g++
BUILD ?= build$(if $(SAN),-$(subst $(comma),-,$(SAN)))
BIN ?= $(if $(SAN),$(BUILD)/bin,bin)
PREFIX ?= /usr/local
FUZZ_SECONDS ?= 60
CLANG ?= clang++
OPTIMIZE ?= -O2
# g++ 12 sees uninitialised memory in std::regex and std::variant when it instruments them; clang knows no such warning.
san_quiet := -Wno-unknown-warning-option -Wno-maybe-uninitialized
# -ffp-contract=off: a fused multiply-add would give other bits on machines that have one.
# -Wno-psabi: wide vectors (rayshade/accel/simd.h) never leave the function that makes them.
FLAGS := -std=c++20 $(OPTIMIZE) -g1 -Wall -Wextra -Werror -Wno-psabi -ffp-contract=off -I. \
         $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer $(san_quiet))
LIBRARIES := -lpng
# One tree serves tests and fuzzers; it is the one that clang compiles, too.  What is left out crashes anyway (null),
# does no harm here (alignment) or finds little; together they are a third of the time to compile.
sanitized := SAN=address,undefined OPTIMIZE=-O1 CXX="$(CLANG)" \
             EXTRA_FLAGS="-fsanitize=fuzzer-no-link -fno-sanitize=null,alignment,vptr,object-size"

objects = $(patsubst %.cc,$(BUILD)/%.o,$(1))
find_sources = $(sort $(shell find $(1) -name '*.cc'))

core := $(call objects,$(filter-out rayshade/program/main.cc rayshade/program/error_main.cc,$(call find_sources,rayshade)))
spd := $(call objects,$(filter-out scenes/spd/main.cc,$(call find_sources,scenes/spd)))
pvm_door := $(call objects,pvm/link/pvm_link.cc pvm/link/virtual_machine.cc)
pvm_programs := $(call objects,pvm/program/main.cc pvm/program/host_program.cc)
tasks := $(filter-out $(pvm_door) $(pvm_programs),$(call objects,$(call find_sources,pvm)))
# Tests that need no PVM daemon make one program, those that do another one.
pvm_tests := $(call objects,tests/parallel/pvm_test.cc tests/parallel/pvm_suite_test.cc)
link_test := $(call objects,tests/parallel/link_test.cc)
tests := $(filter-out $(pvm_tests) $(link_test),$(call objects,$(call find_sources,tests/unit tests/property tests/golden tests/parallel tests/fault tests/support) $(wildcard tests/fuzz/any_*.cc)))
# What sanitizers are most likely to find fault with: whoever reads bytes of others or juggles tasks.
guarded_tests := $(call objects,$(foreach name,archive expression fuzz_corpus image_file in_flight local_trace messages object_cache object_stream outbox parser shade_ledger spool tokens wire_format,tests/unit/$(name)_test.cc) \
  tests/fault/fault_test.cc tests/parallel/equivalence_test.cc tests/parallel/schedules_test.cc \
  $(filter-out tests/support/oracle.cc,$(call find_sources,tests/support)) $(wildcard tests/fuzz/any_*.cc))
fuzzers := $(patsubst tests/fuzz/%.cc,$(BIN)/%,$(wildcard tests/fuzz/*_fuzz.cc))
fuzzed := $(call objects,$(wildcard tests/fuzz/any_*.cc))
embree_bench := tests/bench/embree_rate.cc
benches := $(patsubst tests/bench/%.cc,$(BIN)/bench/%,$(filter-out $(embree_bench),$(call find_sources,tests/bench)))

roles := host voxel-trace pyramid-trace shade
programs := $(BIN)/rayshade $(BIN)/rayshade-error $(BIN)/spd $(roles:%=$(BIN)/rayshade-%)
test_programs := $(BIN)/rayshade-tests $(BIN)/link-tests $(BIN)/pvm-tests

.PHONY: all demo check check-sanitized test guarded install fuzz fuzzers bench benches bench-embree experiments format clean packages
all: $(programs)

# What runs for long is worth a tenth more.  -Wno-restrict: g++ 12 then sees overlaps in std::string that are not there (its
# bug 105651).
ifndef SAN
$(core) $(tasks): FLAGS += -O3 -Wno-restrict
endif

$(BUILD)/%.o: %.cc
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(EXTRA_FLAGS) -MMD -MP -c $< -o $@

$(BUILD)/libcore.a: $(core)
$(BUILD)/libtasks.a: $(tasks)
$(BUILD)/libspd.a: $(spd)
$(BUILD)/lib%.a:
	@rm -f $@
	ar rcs $@ $^

link = @mkdir -p $(@D) && echo "link $@" && $(CXX) $(FLAGS) $(EXTRA_FLAGS) $(filter %.o,$^) $(filter %.a,$^) $(1) $(LIBRARIES) -o $@

$(BIN)/rayshade: $(BUILD)/rayshade/program/main.o $(BUILD)/libcore.a
	$(call link)
$(BIN)/rayshade-error: $(BUILD)/rayshade/program/error_main.o $(BUILD)/libcore.a
	$(call link)
$(BIN)/spd: $(BUILD)/scenes/spd/main.o $(BUILD)/libspd.a
	$(call link)
$(BIN)/rayshade-host: $(pvm_programs) $(pvm_door) $(BUILD)/libtasks.a $(BUILD)/libcore.a
	$(call link,-lpvm3)
# The role of a task is the name under which it was started: one program, several names.
$(BIN)/rayshade-voxel-trace $(BIN)/rayshade-pyramid-trace $(BIN)/rayshade-shade: $(BIN)/rayshade-host
	ln -f $< $@
$(BIN)/rayshade-tests: $(tests) $(BUILD)/libtasks.a $(BUILD)/libspd.a $(BUILD)/libcore.a
	$(call link,-lgtest -lgtest_main -lpthread)
$(BIN)/guarded-tests: $(guarded_tests) $(BUILD)/libtasks.a $(BUILD)/libspd.a $(BUILD)/libcore.a
	$(call link,-lgtest -lgtest_main -lpthread)
$(BIN)/link-tests: $(link_test) $(pvm_door) $(BUILD)/libtasks.a $(BUILD)/libcore.a
	$(call link,-lgtest -lpthread -lpvm3)
$(BIN)/pvm-tests: $(pvm_tests) $(call objects,tests/support/program.cc tests/support/suite.cc) $(pvm_door) $(BUILD)/libtasks.a $(BUILD)/libcore.a
	$(call link,-lgtest -lgtest_main -lpthread -lpvm3)
$(fuzzers): $(BIN)/%_fuzz: $(BUILD)/tests/fuzz/%_fuzz.o $(fuzzed) $(BUILD)/libtasks.a $(BUILD)/libcore.a
	$(call link,-fsanitize=fuzzer)
$(BIN)/bench/oracle_fuzz: $(BUILD)/tests/support/oracle.o
$(BIN)/bench/%: $(BUILD)/tests/bench/%.o $(pvm_door) $(BUILD)/libtasks.a $(BUILD)/libspd.a $(BUILD)/libcore.a
	$(call link,-lbenchmark -lpthread -lpvm3)

packages:
	@tests/support/install_packages

demo: packages
	@$(MAKE) --no-print-directory -j2 all
	@tests/support/demo $(BIN)

check: packages
	@$(MAKE) --no-print-directory -j2 SAN=$(SAN) test
check-sanitized:
	@tests/support/install_packages nice
	@$(MAKE) --no-print-directory -j2 $(sanitized) guarded
test: $(programs) $(test_programs)
	@tests/support/run_tests $(BIN)

# Sanitizers make tests eight times slower: fewer random scenes than without.
guarded: $(BIN)/guarded-tests
	@RAYSHADE_TEST_SEEDS=$${RAYSHADE_TEST_SEEDS:-30} PROGRAMS=guarded-tests tests/support/run_tests $(BIN)

benches: $(benches)
bench-embree: LIBRARIES += -lembree3
bench-embree: $(BIN)/bench/embree_rate

bench: $(BIN)/rayshade $(BIN)/rayshade-error $(BIN)/spd
	@PYTHONDONTWRITEBYTECODE=1 tests/bench/speed_and_error/run --bin $(BIN) docs

experiments: all
	@PYTHONDONTWRITEBYTECODE=1 tests/bench/experiments/run $(BIN) $(if $(QUICK),$(BUILD)/experiments --quick,docs/experiments)

fuzz:
	@$(MAKE) --no-print-directory -j2 $(sanitized) fuzzers
	@tests/support/fuzz build-address-undefined/bin $(FUZZ_SECONDS)
fuzzers: $(fuzzers)

install: all
	install -d $(DESTDIR)$(PREFIX)/bin
	install -m 755 $(programs) $(DESTDIR)$(PREFIX)/bin
	@if [ -z "$(DESTDIR)" ]; then \
	  install -d $$HOME/pvm3/bin/LINUX64 && \
	  for role in $(roles); do ln -sf $(abspath $(PREFIX))/bin/rayshade-$$role $$HOME/pvm3/bin/LINUX64/; done; fi

format:
	clang-format -i $(shell find rayshade pvm scenes tests -name '*.cc' -o -name '*.h')
clean:
	rm -rf build build-* bin

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
