% Tables of StatorWatch in MATLAB: CSV from the service as a table, Parquet and Excel by way of files.
% It needs MATLAB R2021a or later. GNU Octave has no tables: read_trend.m is for both.

url = 'http://127.0.0.1:8710/api/v1/exports';
token = '';  % strtrim(fileread('statorwatch.token')), where the service asks who reads

options = weboptions('Timeout', 600);
if ~isempty(token)
    options.HeaderFields = {'Authorization', ['Bearer ' token]};
end

% Straight into a table. Times are RFC 3339 in UTC.
options.ContentType = 'text';
file = [tempname '.csv'];
websave(file, [url '/trend'], 'format', 'csv', options);
reading = detectImportOptions(file, 'TextType', 'string');
reading = setvartype(reading, 'time', 'string');
trend = readtable(file, reading);
trend.time = datetime(extractBefore(trend.time, 20), 'InputFormat', 'yyyy-MM-dd''T''HH:mm:ss', 'TimeZone', 'UTC');

% Parquet keeps types, units and the zone of the times; it is the quickest for long tables.
options.ContentType = 'binary';
file = [tempname '.parquet'];
websave(file, [url '/measurements'], 'format', 'parquet', 'step', 60, 'motor', 'PUMP-A1', options);
measurements = parquetread(file);
measurements.time.TimeZone = 'UTC';

% A workbook, as people get it.
file = [tempname '.xlsx'];
websave(file, [url '/recordings'], 'format', 'xlsx', options);
recordings = readtable(file, 'Sheet', 'recordings', 'VariableNamingRule', 'preserve');

healthy = trend(trend.state == "healthy", :);
plot(trend.time, 100 * trend.condition_level, '.')
ylabel('fault level [% of the turns of a phase]')
