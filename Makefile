# rayshade-pvm
#
#   make              build the programs into bin/
#   make check        install what is missing, build, run all tests
#   make demo         install what is missing, render a picture over PVM, compare it with the sequential one
#   make SAN=address,undefined check     the same with sanitizers, in a build tree of its own
#
# Sources find themselves: a new file needs no edit here.  Every program is linked from one library of the same object
# files, so every program does the same arithmetic.  Only files under pvm/ that say so need libpvm3.

CXX ?= g++
BUILD ?= build$(if $(SAN),-$(subst $(comma),-,$(SAN)))
BIN ?= $(if $(SAN),$(BUILD)/bin,bin)
comma := ,
OPTIMIZE ?= -O2
# -ffp-contract=off: a fused multiply-add would give other bits on machines that have one.
CXXFLAGS := -std=c++20 $(OPTIMIZE) -g1 -Wall -Wextra -Werror -ffp-contract=off -I. $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer) $(EXTRA_CXXFLAGS)
LDFLAGS := $(if $(SAN),-fsanitize=$(SAN)) $(EXTRA_LDFLAGS)

core_sources := $(filter-out %/main.cc,$(shell find rayshade scenes -name '*.cc'))
core_objects := $(core_sources:%.cc=$(BUILD)/%.o)
test_sources := $(shell find tests/unit tests/property tests/golden tests/support -name '*.cc' 2>/dev/null)
test_objects := $(test_sources:%.cc=$(BUILD)/%.o)

.PHONY: all clean format test
all: $(BIN)/rayshade $(BIN)/spd

$(BUILD)/%.o: %.cc
	@mkdir -p $(@D)
	$(CXX) $(CXXFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/libcore.a: $(core_objects)
	@rm -f $@
	ar rcs $@ $^

$(BIN)/rayshade: $(BUILD)/rayshade/main.o $(BUILD)/libcore.a
	@mkdir -p $(@D)
	$(CXX) $(LDFLAGS) $^ -lpng -o $@

$(BIN)/spd: $(BUILD)/scenes/spd/main.o $(BUILD)/libcore.a
	@mkdir -p $(@D)
	$(CXX) $(LDFLAGS) $^ -o $@

$(BIN)/rayshade-tests: $(test_objects) $(BUILD)/libcore.a
	@mkdir -p $(@D)
	$(CXX) $(LDFLAGS) $^ -lpng -lgtest -lgtest_main -lpthread -o $@

test: $(BIN)/rayshade-tests
	$(BIN)/rayshade-tests

format:
	clang-format -i $$(find rayshade pvm tests scenes -name '*.cc' -o -name '*.h')
clean:
	rm -rf build build-* bin

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
