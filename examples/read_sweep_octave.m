% The table of a sweep in GNU Octave 7 or newer: mean of the measure `force` at every value, a number, of `play`.
%   octave-cli --eval "folder = 'out/play'; source examples/read_sweep_octave.m"
file = fopen([folder '/sweep.csv']);
names = strsplit(fgetl(file), ',');
fclose(file);
rows = dlmread([folder '/sweep.csv'], ',', 1, 0, 'emptyvalue', NaN);
column = @(name) rows(:, strcmp(names, name));
[play, ~, place] = unique(column('play [m]'));
force = accumarray(place, column('force [N]'), [], @(f) mean(f(!isnan(f))));
printf('%g m: %.6g N\n', [play force]');
