% Governor: linear model about the steady state, by flyball.
% Small changes: x' = A x + B u, y = C x + D u.
A = [0, 1;
     -42.93467380912206, -0.9534233004876791];
B = [0;
     -2.1742180813349683];
C = [0.09080405024833316, 0];
D = [0];
state_names = {'arm2', 'arm2.rate'};
state_units = {'rad', 'rad/s'};
state_values = [0.7856156814882425, 0];
input_names = {'joints.spin.drive.speed'};
input_units = {'rad/s'};
input_values = [11.0174];
output_names = {'slide'};
output_units = {'m'};
output_values = [0.1500174581252971];
if exist('ss')
  model = ss(A, B, C, D);
  model.StateName = state_names;
  model.InputName = input_names;
  model.OutputName = output_names;
end
