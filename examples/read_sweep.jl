# The table of a sweep in Julia 1.9 or newer with the packages CSV and DataFrames; not tested.
#   julia read_sweep.jl out/play
using CSV, DataFrames, Statistics
folder = get(ARGS, 1, "out/play")
rows = CSV.read(joinpath(folder, "sweep.csv"), DataFrame)
rows = dropmissing(rows, "force [N]")
means = combine(groupby(rows, "play [m]"; sort = true), "force [N]" => mean => "force [N]")
println(means)
