# Everything a newcomer types. Each target installs what is missing and builds what it needs.
.DEFAULT_GOAL := help
SHELL := /bin/bash
BUILD := build

help: ## this list
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /  make \1\t/' | expand -t 20

deps:
	@scripts/install-deps.sh

deps-lint:
	@scripts/install-deps.sh --lint

$(BUILD)/build.ninja: CMakeLists.txt CMakePresets.json | deps
	@cmake --preset release

build: deps $(BUILD)/build.ninja ## the program and the library, Release, into build/
	@cmake --build $(BUILD) --target vantage_program

build-all: deps $(BUILD)/build.ninja
	@cmake --build $(BUILD)

demo: build ## track a real recording and show the result in build/demo/
	@scripts/demo.sh $(BUILD)

test: build-all ## all tests
	@ctest --test-dir $(BUILD) --output-on-failure -j2

bench: deps $(BUILD)/build.ninja ## benchmarks; table on stdout, figures in build/bench.json
	@cmake --build $(BUILD) --target vantage_bench
	@$(BUILD)/bench/vantage_bench --bench_json=$(BUILD)/bench.json

sanitize: deps ## tests under the address and undefined-behaviour sanitizers
	@cmake --preset asan-ubsan
	@cmake --build --preset asan-ubsan
	@ctest --test-dir build-asan-ubsan --output-on-failure -j2

sources = git ls-files '*.h' '*.cc'

format: deps-lint ## clang-format on every source
	@$(sources) | xargs clang-format -i

lint: deps deps-lint $(BUILD)/build.ninja ## clang-format on all, clang-tidy on all but tests; nothing changed
	@$(sources) | xargs clang-format --dry-run --Werror
	@cmake --build $(BUILD) --target vantage_layers
	@git ls-files '*.cc' ':!*_test.cc' ':!*_oracle.cc' | xargs -P2 -n4 clang-tidy -p $(BUILD) --quiet

clean: ## remove everything that was built
	@rm -rf build build-*

.PHONY: help deps deps-lint build build-all demo test bench sanitize format lint clean
