% The table of a sweep in MATLAB R2019a or newer; not tested. Mean of the measure `force` at every value of the parameter `play`.
folder = 'out/play';
rows = parquetread(fullfile(folder, 'sweep.parquet'));
means = groupsummary(rows, 'play', 'mean', 'force');
disp(means)
plot(means.play, means.mean_force, 'o-')
xlabel('play [m]')
ylabel('force [N]')
