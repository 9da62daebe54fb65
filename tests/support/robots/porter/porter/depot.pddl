; ?s is a place on the rail, ?w a width of the gripper
(define (domain depot)
  (:requirements :strips)
  (:predicates (at ?s) (next ?from ?to) (visited ?s) (open ?w) (tighter ?from ?to) (loads ?s) (holding ?w))
  (:action roll
    :parameters (?from ?to)
    :precondition (and (at ?from) (next ?from ?to))
    :effect (and (not (at ?from)) (at ?to) (visited ?to)))
  (:action squeeze
    :parameters (?from ?to ?s)
    :precondition (and (open ?from) (tighter ?from ?to) (at ?s) (loads ?s))
    :effect (and (not (open ?from)) (open ?to) (holding ?to))))
