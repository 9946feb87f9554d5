function trend = read_trend(url, motor, token)
%READ_TREND  The trend of a motor from StatorWatch. For MATLAB and GNU Octave 7 or later.
%
%   trend = read_trend('http://127.0.0.1:8710', 'PUMP-A1')
%   trend = read_trend('https://mcc.plant:8710', 'PUMP-A1', strtrim(fileread('statorwatch.token')))
%
%   Each field of trend is a column of the table: a cell array of text, or a vector of numbers with NaN where
%   nothing is known. trend.time is a serial date number in UTC.
%
%   plot(trend.time, 100 * trend.mu_f, 'o', trend.time, 100 * trend.condition_level), datetick('x')

  texts = {'motor', 'time', 'verdict', 'state', 'kind', 'phase', 'recording_id'};
  options = weboptions('ContentType', 'text', 'Timeout', 120);
  if nargin > 2 && ~isempty(token)
    options.HeaderFields = {'Authorization', ['Bearer ' token]};
  end
  csv = webread([url '/api/v1/exports/trend'], 'format', 'csv', 'motor', motor, options);

  lines = regexp(strtrim(csv), '\r?\n', 'split');
  names = cells_of(lines{1});
  rows = cellfun(@cells_of, lines(2:end), 'UniformOutput', false);
  rows = vertcat(cell(0, numel(names)), rows{:});
  trend = struct();
  for at = 1:numel(names)
    if any(strcmp(names{at}, texts))
      trend.(names{at}) = rows(:, at);
    else
      trend.(names{at}) = str2double(rows(:, at));  % NaN where a cell is empty
    end
  end
  % 2026-01-31T12:00:00.123456789Z, to the second
  trend.time = cellfun(@(when) datenum(when(1:19), 'yyyy-mm-ddTHH:MM:SS'), trend.time);
end

function cells = cells_of(line)
% The cells of a line of CSV, without their quotation marks.
  found = regexp([line ','], '("(?:[^"]|"")*"|[^,]*),', 'tokens');
  cells = cellfun(@(token) token{1}, found, 'UniformOutput', false);
  quoted = strncmp(cells, '"', 1);
  cells(quoted) = cellfun(@(text) strrep(text(2:end-1), '""', '"'), cells(quoted), 'UniformOutput', false);
end
