// Runs a scene with the reference implementation, to try it without another program:
//
//     reference SCENE.toml [--set PATH=VALUE]... [--out channels.csv] [--onsets onsets.csv] [--unstable steps.csv] [--until T]
//               [--relative R] [--position P] [--velocity V] [--sparse] [--all] [--start]
//
// --start prints the start and ends, --all writes every channel instead of those that the scene selects.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference.h"

namespace {

struct Options {
    std::string scene, out, onsets, unstable;
    std::vector<std::string> overrides;
    double until = -1.0;
    bool start_only = false, all = false;
    ls_tolerances tolerances{1e-8, 1e-9, 1e-6, 0.0, 0.05, 5, LS_DENSE, 100000000};
};

struct Free {
    void operator()(ls_scene *scene) const { ls_scene_free(scene); }
    void operator()(ls_run *run) const { ls_run_free(run); }
};

Options parse(int count, char **arguments) {
    Options options;
    for (int i = 1; i < count; ++i) {
        const std::string word = arguments[i];
        auto next = [&]() -> std::string {
            if (++i >= count) throw std::runtime_error(word + " needs a value");
            return arguments[i];
        };
        if (word == "--set")
            options.overrides.push_back(next());
        else if (word == "--out")
            options.out = next();
        else if (word == "--onsets")
            options.onsets = next();
        else if (word == "--unstable")
            options.unstable = next();
        else if (word == "--until")
            options.until = std::stod(next());
        else if (word == "--relative")
            options.tolerances.relative = std::stod(next());
        else if (word == "--position")
            options.tolerances.position = std::stod(next());
        else if (word == "--velocity")
            options.tolerances.velocity = std::stod(next());
        else if (word == "--sparse")
            options.tolerances.linear_solver = LS_SPARSE;
        else if (word == "--all")
            options.all = true;
        else if (word == "--start")
            options.start_only = true;
        else if (options.scene.empty() && word[0] != '-')
            options.scene = word;
        else
            throw std::runtime_error("unknown argument " + word);
    }
    if (options.scene.empty()) throw std::runtime_error("usage: reference SCENE.toml [--set PATH=VALUE]...");
    return options;
}

std::string read_file(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::runtime_error described(const std::string &file, const ls_error &error) {
    std::string text = file;
    if (error.line > 0) text += ":" + std::to_string(error.line) + ":" + std::to_string(error.column);
    if (error.field[0] != 0) text += ": " + std::string(error.field);
    text += ": " + std::string(error.message);
    if (error.time != 0.0) text += " (t = " + std::to_string(error.time) + ")";
    return std::runtime_error(text);
}

void print_start(const ls_scene *scene) {
    const std::size_t n = ls_scene_count(scene, LS_COORDINATE), m = ls_scene_count(scene, LS_CONSTRAINT);
    std::vector<double> q(n), v(n), phi(m), phi_q(m * n), phi_t(m);
    ls_error error;
    ls_scene_start(scene, q.data(), v.data(), &error);
    ls_scene_constraint_rows(scene, 0.0, q.data(), phi.data(), phi_q.data(), phi_t.data(), &error);
    double position = 0.0, velocity = 0.0;
    for (std::size_t k = 0; k < m; ++k) {
        double rate = phi_t[k];
        for (std::size_t i = 0; i < n; ++i) rate += phi_q[k * n + i] * v[i];
        position = std::fmax(position, std::fabs(phi[k]));
        velocity = std::fmax(velocity, std::fabs(rate));
    }
    for (std::size_t i = 0; i < n; ++i)
        std::printf("%-28s %24.16e %24.16e\n", ls_scene_name(scene, LS_COORDINATE, i), q[i], v[i]);
    std::vector<double> states(ls_scene_count(scene, LS_STATE));
    ls_scene_states(scene, states.data(), &error);
    for (std::size_t i = 0; i < states.size(); ++i)
        std::printf("%-28s %24.16e\n", ls_scene_name(scene, LS_STATE, i), states[i]);
    for (std::size_t i = 0; i < ls_scene_count(scene, LS_REDUNDANT); ++i)
        std::printf("redundant: %s\n", ls_scene_name(scene, LS_REDUNDANT, i));
    std::printf("%zu coordinates, %zu constraints, violated by %.1e m, %.1e m/s\n", n, m, position, velocity);
}

void print_rest(const ls_scene *scene, const ls_rest &rest) {
    if (rest.coordinate < 0) {
        std::printf("equilibrium: nothing can move\n");
        return;
    }
    const char *kind = rest.stability > 0 ? "stable" : rest.stability < 0 ? "unstable" : "neutral";
    std::printf("equilibrium: %s, smallest eigenvalue %.9g 1/s2, %s\n", kind, rest.eigenvalue,
                ls_scene_name(scene, LS_COORDINATE, static_cast<std::size_t>(rest.coordinate)));
}

void print_path(const ls_scene *scene, const ls_run *run) {
    for (std::size_t i = 0; i < ls_run_critical_count(run); ++i) {
        ls_critical_point c;
        ls_run_critical_point(run, i, &c);
        std::printf("%s at t = %.12g, %.12g of the load, %s\n", c.is_limit ? "limit point" : "bifurcation", c.t, c.part,
                    ls_scene_name(scene, LS_COORDINATE, static_cast<std::size_t>(c.coordinate)));
    }
    ls_rest rest;
    if (ls_run_rest(run, &rest, nullptr) == LS_OK) print_rest(scene, rest);
}

// The steps along unstable paths, every channel.
void write_unstable(const ls_scene *scene, const ls_run *run, const std::string &path) {
    const std::size_t count = ls_scene_count(scene, LS_CHANNEL);
    std::vector<double> values(count);
    std::ofstream file(path);
    file.precision(17);
    for (std::size_t i = 0; i < count; ++i) file << (i > 0 ? "," : "") << ls_scene_name(scene, LS_CHANNEL, i);
    file << "\n";
    for (std::size_t row = 0; row < ls_run_unstable_count(run); ++row) {
        ls_error error{};
        if (ls_run_unstable(run, row, values.data(), &error) != LS_OK) throw described(path, error);
        for (std::size_t i = 0; i < count; ++i) file << (i > 0 ? "," : "") << values[i];
        file << "\n";
    }
}

void write_rows(const ls_scene *scene, ls_run *run, const Options &options, const ls_description &description) {
    const std::size_t count = ls_scene_count(scene, LS_CHANNEL);
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < (options.all ? count : ls_scene_count(scene, LS_SELECTED)); ++i)
        columns.push_back(options.all ? i : ls_scene_selected(scene, i));
    std::ofstream file;
    if (!options.out.empty()) file.open(options.out);
    file.precision(17);
    for (std::size_t i = 0; i < columns.size(); ++i)
        file << (i > 0 ? "," : "") << ls_scene_name(scene, LS_CHANNEL, columns[i]);
    file << "\n";

    std::size_t numerical = 0;
    std::vector<std::size_t> in_play; // energies whose sum tells whether a drift is large
    for (std::size_t i = 0; i < count; ++i) {
        const std::string name = ls_scene_name(scene, LS_CHANNEL, i);
        if (name == "energy.numerical") numerical = i;
        for (const char *energy : {"kinetic", "axial", "bending", "contact", "springs"})
            if (name == std::string("energy.") + energy) in_play.push_back(i);
    }
    std::vector<double> values(count);
    double drift = 0.0, most_energy = 0.0, t = 0.0;
    const double until = options.until >= 0.0 ? std::fmin(options.until, description.duration) : description.duration;
    ls_error error{};
    long rows = 0;
    for (;; ++rows) {
        t = static_cast<double>(rows) * description.interval;
        if (t > until * (1.0 + 1e-9)) break;
        if (ls_run_advance(run, t, values.data(), &error) != LS_OK) break;
        double energy = 0.0;
        for (std::size_t i : in_play) energy += values[i];
        most_energy = std::fmax(most_energy, energy);
        if (numerical > 0) drift = std::fmax(drift, std::fabs(values[numerical]));
        for (std::size_t i = 0; i < columns.size(); ++i) file << (i > 0 ? "," : "") << values[columns[i]];
        file << "\n";
    }
    ls_statistics s;
    ls_run_statistics(run, &s);
    std::printf("%lld steps, %lld residuals, %lld jacobians, %lld restarts, %zu events, to %.4g s\n",
                static_cast<long long>(s.steps), static_cast<long long>(s.residuals),
                static_cast<long long>(s.jacobians), static_cast<long long>(s.restarts), ls_run_event_count(run),
                static_cast<double>(rows - 1) * description.interval);
    std::printf("energy.numerical up to %.2e J of %.2e J kinetic and elastic energy\n", drift, most_energy);
    print_path(scene, run);
    if (!options.unstable.empty()) write_unstable(scene, run, options.unstable);
    if (error.code != LS_OK) throw described(options.scene, error);
}

void write_onsets(const ls_scene *scene, const ls_run *run, const std::string &path) {
    std::ofstream file(path);
    file.precision(17);
    file << "t,joint,onset,velocity,ex,ey,deepest_penetration\n";
    for (std::size_t i = 0; i < ls_run_event_count(run); ++i) {
        ls_event e;
        ls_run_event(run, i, &e);
        file << e.time << "," << ls_scene_name(scene, LS_JOINT, static_cast<std::size_t>(e.joint)) << "," << e.onset
             << "," << e.velocity << "," << e.eccentricity_x << "," << e.eccentricity_y << "," << e.deepest << "\n";
    }
}

void run_scene(const Options &options) {
    std::vector<const char *> overrides;
    for (const std::string &assignment : options.overrides) overrides.push_back(assignment.c_str());
    ls_error error{};
    const std::unique_ptr<ls_scene, Free> scene(
        ls_scene_read(read_file(options.scene).c_str(), overrides.data(), overrides.size(), &error));
    if (!scene) throw described(options.scene, error);
    ls_description description;
    ls_scene_describe(scene.get(), &description);
    std::printf("%s\n", description.title);
    for (std::size_t i = 0; i < ls_scene_count(scene.get(), LS_NOTE); ++i)
        std::printf("note: %s\n", ls_scene_name(scene.get(), LS_NOTE, i));
    ls_rest rest;
    if (ls_scene_rest(scene.get(), &rest, nullptr) == LS_OK) print_rest(scene.get(), rest);
    if (options.start_only) {
        print_start(scene.get());
        return;
    }
    const std::unique_ptr<ls_run, Free> run(ls_run_new(scene.get(), &options.tolerances, &error));
    if (!run) throw described(options.scene, error);
    const auto begin = std::chrono::steady_clock::now();
    write_rows(scene.get(), run.get(), options, description);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    std::printf("%.2f s\n", spent.count());
    if (!options.onsets.empty()) write_onsets(scene.get(), run.get(), options.onsets);
}

} // namespace

int main(int count, char **arguments) {
    try {
        run_scene(parse(count, arguments));
        return EXIT_SUCCESS;
    } catch (const std::exception &e) {
        std::cerr << e.what() << "\n";
        return EXIT_FAILURE;
    }
}
